#include "base/exr_claims.h"

#include <openexr.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <fstream>
#include <map>
#include <string>
#include <string_view>

#include "base/error.h"

namespace lumulus {
namespace {

namespace fs = std::filesystem;

constexpr double maximumValues = double{1U << 28U};
// Bytes that any file may claim: tiles and blocks of rows may be larger than the picture.
constexpr double allowedPixels = 16.0 * 1024.0 * 1024.0;
constexpr double allowedBlock = 64.0 * 1024.0 * 1024.0;

/// An open header. Closed with the object.
class ExrHeader {
  public:
    explicit ExrHeader(const fs::path& path) {
        exr_context_initializer_t options = EXR_DEFAULT_CONTEXT_INITIALIZER;
        options.error_handler_fn = [](exr_const_context_t, exr_result_t, const char*) {};  // by itself it prints
        options.flags = EXR_CONTEXT_FLAG_SILENT_HEADER_PARSE;
        result_ = exr_start_read(&context_, path.c_str(), &options);
    }
    ExrHeader(const ExrHeader&) = delete;
    ExrHeader& operator=(const ExrHeader&) = delete;
    ~ExrHeader() { exr_finish(&context_); }

    exr_result_t result() const { return result_; }
    exr_const_context_t get() const { return context_; }

  private:
    exr_context_t context_ = nullptr;
    exr_result_t result_ = EXR_ERR_SUCCESS;
};

/// How many bytes of pixels one byte of a file can stand for at most.
double densestPacking(exr_compression_t compression) {
    switch (compression) {
        case EXR_COMPRESSION_NONE:
            return 1.0;
        case EXR_COMPRESSION_RLE:
            return 64.0;  // a run has 128 bytes at most and takes two
        case EXR_COMPRESSION_B44:
        case EXR_COMPRESSION_B44A:
            return 32.0;  // floats are kept; a flat block of 4 × 4 values of 2 bytes takes 3
        case EXR_COMPRESSION_DWAA:
        case EXR_COMPRESSION_DWAB:
            return 64.0 * 1032.0;  // a flat block of 8 × 8 values is one symbol, and symbols are deflated
        case EXR_COMPRESSION_PXR24:
            return 4.0 / 3.0 * 1032.0;  // floats of three bytes are deflated
        default:
            return 1032.0;  // deflate's limit (zlib's technical details); a run of PIZ's Huffman code gives about 400
    }
}

std::int64_t sizeOf(std::int32_t first, std::int32_t last) {
    return std::int64_t{last} - first + 1;
}

/// Bytes of all channels of a pixel, and the number of channels.
struct Pixel {
    double bytes = 0.0;
    double values = 0.0;
};

Pixel pixelOf(exr_const_context_t header, int part) {
    const exr_attr_chlist_t* channels = nullptr;
    Pixel pixel;
    if (exr_get_channels(header, part, &channels) != EXR_ERR_SUCCESS) return pixel;
    for (int i = 0; i < channels->num_channels; ++i)
        pixel.bytes += channels->entries[i].pixel_type == EXR_PIXEL_HALF ? 2.0 : 4.0;
    pixel.values = channels->num_channels;
    return pixel;
}

[[noreturn]] void refuse(const fs::path& path, const std::string& what) {
    throw InputError(what, path.string(), "write or copy it again");
}

/// Types of attributes whose values always take the same bytes: OpenEXR reads as many, whatever a file claims.
const std::map<std::string_view, std::int32_t> fixedBytes{{"box2f", 16},
                                                          {"box2i", 16},
                                                          {"chromaticities", 32},
                                                          {"compression", 1},
                                                          {"deepImageState", 1},
                                                          {"double", 8},
                                                          {"envmap", 1},
                                                          {"float", 4},
                                                          {"int", 4},
                                                          {"keycode", 28},
                                                          {"lineOrder", 1},
                                                          {"m33d", 72},
                                                          {"m33f", 36},
                                                          {"m44d", 128},
                                                          {"m44f", 64},
                                                          {"rational", 8},
                                                          {"tiledesc", 9},
                                                          {"timecode", 8},
                                                          {"v2d", 16},
                                                          {"v2f", 8},
                                                          {"v2i", 8},
                                                          {"v3d", 24},
                                                          {"v3f", 12},
                                                          {"v3i", 12}};

/// Bytes that OpenEXR reads of the value of an attribute that claims so many.
std::int32_t bytesRead(const std::string& type, std::int32_t claimed) {
    if (type == "floatvector") return claimed / 4 * 4;
    const auto fixed = fixedBytes.find(type);
    return fixed == fixedBytes.end() ? claimed : fixed->second;
}

/// Whether the list of channels at the file's place ends where it claims to: OpenEXR goes on at its last name, which is
/// empty, and takes what follows there for further attributes.
bool channelsFillTheirList(std::ifstream& file, std::int32_t bytes) {
    constexpr std::streamoff afterName = 16;  // type, linearity, distances of samples
    const std::streamoff end = file.tellg() + std::streamoff{bytes};
    while (file && file.tellg() < end) {
        if (file.peek() == 0) return file.tellg() + std::streamoff{1} == end;
        while (file.get() > 0) {
        }
        file.seekg(afterName, std::ios::cur);
    }
    return false;
}

/// Attributes of all headers. OpenEXR takes the memory that one claims before it reads.
void checkAttributes(const fs::path& path, std::uint64_t fileBytes) {
    static_assert(std::endian::native == std::endian::little);
    constexpr std::uint32_t manyParts = 0x1000;
    constexpr std::streamsize longestName = 256;
    std::ifstream file(path, std::ios::binary);
    std::uint32_t version[2] = {};
    file.read(reinterpret_cast<char*>(version), sizeof(version));
    char name[longestName], type[longestName];
    while (file.getline(name, longestName, '\0')) {
        if (name[0] == '\0') {  // the end of a header
            if ((version[1] & manyParts) == 0 || file.peek() == 0) return;
            continue;
        }
        std::int32_t bytes = 0;
        file.getline(type, longestName, '\0').read(reinterpret_cast<char*>(&bytes), sizeof(bytes));
        if (!file) return;  // what is wrong there OpenEXR says
        const auto begin = static_cast<std::uint64_t>(file.tellg());
        if (bytes < 0 || static_cast<std::uint64_t>(bytes) > fileBytes - begin)
            refuse(path, "an attribute claims " + std::to_string(bytes) + " bytes, more than the file can hold");
        if (bytes != bytesRead(type, bytes))
            refuse(path,
                   "an attribute of the type " + std::string(type) + " claims " + std::to_string(bytes) + " bytes");
        if (std::string_view(type) == "chlist" && !channelsFillTheirList(file, bytes))
            refuse(path, "the list of channels does not have the length that it claims");
        file.seekg(static_cast<std::streamoff>(begin) + bytes);
    }
}

/// The part that is read.
void checkPicture(exr_const_context_t header, const fs::path& path, double fileBytes) {
    constexpr int part = 0;
    exr_attr_box2i_t window{};
    exr_compression_t compression = EXR_COMPRESSION_NONE;
    exr_get_data_window(header, part, &window);
    exr_get_compression(header, part, &compression);
    const std::int64_t width = sizeOf(window.min.x, window.max.x), height = sizeOf(window.min.y, window.max.y);
    const Pixel pixel = pixelOf(header, part);
    const double pixels = static_cast<double>(width) * static_cast<double>(height);
    const std::string size = std::to_string(width) + " × " + std::to_string(height);
    const double packed = fileBytes * densestPacking(compression);
    if (!(pixels * pixel.bytes <= std::max(allowedPixels, packed)))
        refuse(path, "the picture claims " + size + " pixels, more than the file can hold");
    if (!(pixels * pixel.values <= maximumValues))
        throw InputError("the picture of " + size + " pixels is too large to read", path.string(),
                         "crop it or drop some layers");
    std::uint64_t blockBytes = 0;
    exr_get_chunk_unpacked_size(header, part, &blockBytes);
    if (!(static_cast<double>(blockBytes) <= std::max(allowedBlock, packed)))
        refuse(path, "the picture of " + size + " pixels claims tiles or blocks of rows of " +
                         std::to_string(blockBytes) + " bytes, more than the file can hold");
}

}  // namespace

void checkExrClaims(const fs::path& path) {
    const ExrHeader header(path);
    if (header.result() != EXR_ERR_SUCCESS)
        throw InputError(std::string("cannot read the picture: ") + exr_get_default_error_message(header.result()),
                         path.string(), "give an EXR picture");
    const auto fileBytes = static_cast<double>(fs::file_size(path));
    checkAttributes(path, fs::file_size(path));
    int parts = 0;
    exr_get_count(header.get(), &parts);
    for (int part = 0; part < parts; ++part) {
        constexpr double bytesInList = 8.0;  // where a block of pixels begins
        std::int32_t blocks = 0;
        const exr_result_t result = exr_get_chunk_count(header.get(), part, &blocks);
        if (result != EXR_ERR_SUCCESS || bytesInList * blocks > fileBytes)
            refuse(path, "the picture claims more blocks of pixels than the file can hold");
    }
    checkPicture(header.get(), path, fileBytes);
}

}  // namespace lumulus
