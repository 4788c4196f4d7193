#include "mesh/gltf_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <span>
#include <vector>

#include "base/error.h"
#include "base/text.h"

namespace lumulus::mesh {
namespace {

constexpr std::uintmax_t mostBytes = std::uintmax_t{1} << 30U;  ///< of one file
constexpr int deepestJson = 64;

/// Where files may be read, and what was refused.
struct Folder {
    std::filesystem::path path;  ///< with links followed
    std::string prefix;          ///< as tinygltf joins names to it
    std::string refused;         ///< a name outside of the folder
};

/// Reads a whole file; false where it cannot be read or is too large.
bool readBytes(const std::filesystem::path& path, std::vector<unsigned char>& bytes) {
    std::error_code ec;
    if (!std::filesystem::is_regular_file(path, ec)) return false;
    const std::uintmax_t size = std::filesystem::file_size(path, ec);
    if (ec || size > mostBytes) return false;
    std::ifstream stream(path, std::ios::binary);
    bytes.resize(size);
    stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
    return !stream.fail() || (size == 0 && stream.eof());
}

bool isInside(const Folder& folder, const std::string& name) {
    std::error_code ec;
    const std::filesystem::path real = std::filesystem::weakly_canonical(name, ec);
    return !ec && std::ranges::mismatch(folder.path, real).in1 == folder.path.end();
}

/// Only files of the folder exist; tinygltf looks for others where the program runs.
bool existsInside(const std::string& name, void* user) {
    Folder& folder = *static_cast<Folder*>(user);
    if (!name.starts_with(folder.prefix)) return false;
    if (!isInside(folder, name)) {
        folder.refused = name;
        return false;
    }
    std::error_code ec;
    return std::filesystem::is_regular_file(name, ec);
}

bool readInside(std::vector<unsigned char>* out, std::string* error, const std::string& name, void* user) {
    const Folder& folder = *static_cast<Folder*>(user);
    if (isInside(folder, name) && readBytes(name, *out)) return true;
    if (error != nullptr) *error += "cannot read " + name;
    return false;
}

std::string sameName(const std::string& name, void* /*user*/) {
    return name;
}

/// Keeps the bytes of a picture. Those in buffers are read later, when their place has been checked.
bool keepPicture(tinygltf::Image* image, int /*index*/, std::string* /*error*/, std::string* /*warning*/, int /*width*/,
                 int /*height*/, const unsigned char* bytes, int size, void* /*user*/) {
    if (image->bufferView < 0 && size > 0) image->image.assign(bytes, bytes + size);
    return true;
}

/// The text of a .glb or .gltf file.
std::span<const unsigned char> jsonOf(std::span<const unsigned char> file, bool binary) {
    if (!binary) return file;
    constexpr std::size_t header = 20;
    if (file.size() < header) return {};
    std::uint32_t length = 0;
    std::memcpy(&length, file.data() + 12, sizeof(length));
    return file.subspan(header, std::min<std::size_t>(length, file.size() - header));
}

/// How deep brackets are nested, outside of strings: readers of JSON use the stack.
int depthOf(std::span<const unsigned char> json) {
    int depth = 0, deepest = 0;
    bool quoted = false;
    for (std::size_t i = 0; i < json.size(); ++i) {
        const unsigned char c = json[i];
        if (quoted) {
            if (c == '\\') ++i;
            if (c == '"') quoted = false;
            continue;
        }
        if (c == '"') quoted = true;
        if (c == '[' || c == '{') deepest = std::max(deepest, ++depth);
        if (c == ']' || c == '}') --depth;
    }
    return deepest;
}

}  // namespace

void failGltf(const std::filesystem::path& file, const std::string& what, const std::string& mend) {
    throw InputError(shortened(oneLine(what), 300), file.string(), mend);
}

tinygltf::Model readGltf(const std::filesystem::path& file) {
    constexpr const char* again = "give a glTF 2.0 file that is whole";
    std::vector<unsigned char> bytes;
    if (!readBytes(file, bytes)) failGltf(file, "cannot read the file", "give a file of at most 1 GiB");
    const bool binary = bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0;
    if (depthOf(jsonOf(bytes, binary)) > deepestJson)
        failGltf(file, "its JSON is nested more than 64 deep", "export it again");
    std::error_code ec;
    const std::string prefix = file.has_parent_path() ? file.parent_path().string() : ".";
    Folder folder{std::filesystem::weakly_canonical(prefix, ec), prefix, {}};
    tinygltf::TinyGLTF reader;
    reader.SetImageLoader(keepPicture, nullptr);
    reader.SetFsCallbacks({existsInside, sameName, readInside, nullptr, &folder});
    tinygltf::Model model;
    std::string error, warning;
    bool read = false;
    try {
        const auto size = static_cast<unsigned int>(bytes.size());
        read = binary ? reader.LoadBinaryFromMemory(&model, &error, &warning, bytes.data(), size, prefix)
                      : reader.LoadASCIIFromString(&model, &error, &warning,
                                                   reinterpret_cast<const char*>(bytes.data()), size, prefix);
    } catch (const std::exception& e) {
        error = e.what();
    }
    if (!folder.refused.empty())
        failGltf(file, fmt::format("it names {}, which lies outside of its folder", folder.refused),
                 "put all its files beside it or in folders below");
    if (!read) failGltf(file, "it is no glTF 2.0: " + (error.empty() ? "it is damaged" : error), again);
    return model;
}

}  // namespace lumulus::mesh
