#include "vdb/header.h"

#include <cstdint>
#include <fstream>
#include <map>
#include <string>

namespace lumulus::vdb {
namespace {

/// Types of metadata whose values have a fixed size.
const std::map<std::string, std::uint32_t> kNumberBytes{
    {"bool", 1},   {"int32", 4},  {"int64", 8},  {"float", 4},  {"double", 8}, {"vec2i", 8},  {"vec2s", 8},
    {"vec2d", 16}, {"vec3i", 12}, {"vec3s", 12}, {"vec3d", 24}, {"mat4s", 64}, {"mat4d", 128}};

/// Walks over a file and notes if a length led past the end of the file.
class Walk {
  public:
    explicit Walk(const std::filesystem::path& path)
        : in_(path, std::ios::binary), size_(static_cast<std::int64_t>(std::filesystem::file_size(path))) {}

    bool within() const { return within_; }

    void moveTo(std::int64_t position) {
        within_ = within_ && position >= position_ && position <= size_;
        if (within_) position_ = position;
    }

    template <typename Number>
    Number number() {
        Number value{};
        const std::int64_t start = position_;
        moveTo(position_ + static_cast<std::int64_t>(sizeof(Number)));
        if (!within_) return value;
        in_.seekg(start);
        in_.read(reinterpret_cast<char*>(&value), sizeof(Number));
        return value;
    }

    void bytes(std::int64_t count) { moveTo(position_ + count); }

    /// Reads a 32-bit length and that many bytes. Returns the bytes if they are few, like the names of types.
    std::string sized() {
        constexpr std::uint32_t longest = 16;
        const auto length = number<std::uint32_t>();
        const std::int64_t start = position_;
        bytes(length);
        std::string text;
        if (within_ && length <= longest) {
            text.resize(length);
            in_.seekg(start);
            in_.read(text.data(), length);
        }
        return text;
    }

    /// Walks over name, type and value of each entry. OpenVDB reads numbers by their own size, not by the file's.
    void metadata() {
        const auto entries = number<std::int32_t>();
        for (std::int32_t i = 0; i < entries && within_; ++i) {
            sized();
            const auto known = kNumberBytes.find(sized());
            const auto length = number<std::uint32_t>();
            within_ = within_ && (known == kNumberBytes.end() || known->second == length);
            bytes(length);
        }
    }

  private:
    std::ifstream in_;
    std::int64_t size_ = 0;
    std::int64_t position_ = 0;
    bool within_ = true;
};

}  // namespace

// The layout is that of OpenVDB 10's io/Archive.cc and io/GridDescriptor.cc.
bool headerLengthsFit(const std::filesystem::path& path) {
    constexpr std::uint32_t oldestFormat = 222;
    Walk walk(path);
    walk.bytes(8);  // the magic number
    if (walk.number<std::uint32_t>() < oldestFormat) return walk.within();
    walk.bytes(8);  // the library's version
    const bool seekable = walk.number<std::uint8_t>() != 0;
    walk.bytes(36);  // a UUID in text
    walk.metadata();
    const auto grids = walk.number<std::int32_t>();
    for (std::int32_t i = 0; i < grids && walk.within(); ++i) {
        for (int name = 0; name < 3; ++name) walk.sized();  // of the grid, its type and the grid whose tree it shares
        walk.bytes(16);                                     // where the grid and its values begin
        const auto end = walk.number<std::int64_t>();
        walk.bytes(4);  // flags of compression
        walk.metadata();
        walk.sized();  // the type of the transform
        if (!seekable) break;
        walk.moveTo(end);
    }
    return walk.within();
}

}  // namespace lumulus::vdb
