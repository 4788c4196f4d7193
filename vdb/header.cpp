#include "vdb/header.h"

#include <openvdb/Metadata.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <string>

#include "base/error.h"

namespace lumulus::vdb {
namespace {

/// Bytes of the value of a type of metadata that OpenVDB reads by its own size, not by the file's; 0: it reads what the
/// file tells.
std::uint32_t fixedBytes(const std::string& type) {
    using openvdb::Metadata;
    return Metadata::isRegisteredType(type) ? Metadata::createMetadata(type)->size() : 0;
}

/// The type of metadata that has masks and sizes of leaves.
constexpr const char* kLeavesForLater = "__delayedload";

/// Walks over a file from a position on and notes if a length led past the end of the file.
class Walk {
  public:
    Walk(std::ifstream& in, std::int64_t size, std::int64_t position) : in_(in), size_(size), position_(position) {}

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
        constexpr std::uint32_t longest = 64;
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

    /// Walks over name, type and value of each entry.
    void metadata() {
        const auto entries = number<std::uint32_t>();
        for (std::uint32_t i = 0; i < entries && within_; ++i) {
            sized();
            const std::string type = sized();
            const std::uint32_t fixed = fixedBytes(type);
            const auto length = number<std::uint32_t>();
            within_ = within_ && (fixed == 0 || fixed == length);
            const std::int64_t start = position_;
            bytes(length);
            if (type == kLeavesForLater && length > 0) leavesForLater(start, position_);
        }
    }

  private:
    /// Where OpenVDB would find the leaves' values later on: it reads by the numbers in there, whatever the length that
    /// the file tells. They are a number for each leaf and, twice, the bytes that follow: a chunk of Blosc, or the
    /// numbers themselves where that is 0.
    void leavesForLater(std::int64_t start, std::int64_t end) {
        constexpr std::int64_t bytesOfLeaf = 64;  // its mask, at least
        constexpr std::uint32_t none = 0xFFFFFFFF;
        position_ = start;
        const auto leaves = static_cast<std::int64_t>(number<std::uint32_t>());
        within_ = within_ && leaves <= size_ / bytesOfLeaf;
        for (const std::int64_t bytesOfNumber : {1, 8}) {
            const auto stored = number<std::uint32_t>();
            if (stored == none && bytesOfNumber > 1) break;
            if (stored == 0)
                bytes(leaves * bytesOfNumber);
            else
                chunk(stored, leaves * bytesOfNumber);
        }
        within_ = within_ && position_ <= end;
        position_ = end;
    }

    /// A chunk of Blosc, whose head tells how many bytes become of it.
    void chunk(std::int64_t stored, std::int64_t most) {
        constexpr std::int64_t least = 128;  // OpenVDB fills smaller ones up
        const std::int64_t start = position_;
        bytes(4);
        const auto unpacked = static_cast<std::int64_t>(number<std::uint32_t>());
        within_ = within_ && stored >= 16 && unpacked <= std::max(most, least);
        position_ = start;
        bytes(stored);
    }

    std::ifstream& in_;
    std::int64_t size_;
    std::int64_t position_;
    bool within_ = true;
};

}  // namespace

HeadCheck::HeadCheck(const std::filesystem::path& path) : path_(path), in_(path, std::ios::binary) {
    size_ = static_cast<std::int64_t>(std::filesystem::file_size(path));
}

template <typename Steps>
void HeadCheck::walk(std::int64_t position, const Steps& steps) {
    in_.clear();
    Walk walk(in_, size_, position);
    steps(walk);
    if (!walk.within())
        throw InputError("the file is truncated or damaged: its header leads past its end", path_.string(),
                         "copy or write it again");
}

void HeadCheck::metadata(std::int64_t position) {
    walk(position, [](Walk& walk) { walk.metadata(); });
}

// The layout is that of OpenVDB 10's io/GridDescriptor.cc.
void HeadCheck::descriptor(std::int64_t position) {
    walk(position, [](Walk& walk) {
        for (int name = 0; name < 3; ++name) walk.sized();  // of the grid, its type and the grid whose tree it shares
    });
}

void HeadCheck::text(std::int64_t position) {
    walk(position, [](Walk& walk) { walk.sized(); });
}

}  // namespace lumulus::vdb
