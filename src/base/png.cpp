#include "base/png.h"

#include <png.h>

#include <cassert>
#include <csetjmp>
#include <cstddef>
#include <exception>
#include <string>
#include <utility>

#include "base/atomic_file.h"
#include "base/error.h"

namespace lumulus {
namespace {

/// Where a picture is encoded to, and why that failed.
struct Sink {
    std::vector<std::byte> bytes;
    std::string error;
};

void append(png_structp png, png_bytep data, png_size_t size) {
    try {
        auto& bytes = static_cast<Sink*>(png_get_io_ptr(png))->bytes;
        const auto* first = reinterpret_cast<const std::byte*>(data);
        bytes.insert(bytes.end(), first, first + size);
        return;
    } catch (const std::exception&) {  // must not pass through libpng
    }
    png_error(png, "no memory");
}

void noFlush(png_structp) {}

void noteError(png_structp png, png_const_charp message) {
    static_cast<Sink*>(png_get_error_ptr(png))->error = message;
    png_longjmp(png, 1);
}

void ignoreWarning(png_structp, png_const_charp) {}

/// libpng leaves by longjmp where it fails: nothing here has a destructor. Returns false then.
bool encode(Sink& sink, int width, int height, bool alpha, const std::uint8_t* pixels) {
    // A picture of a sky is as small by level 4 of differences as by the default level 6, in a quarter of the time.
    constexpr int level = 4, bits = 8;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &sink, noteError, ignoreWarning);
    png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);
    if (info == nullptr || setjmp(png_jmpbuf(png)) != 0) {
        png_destroy_write_struct(&png, &info);
        return false;
    }
    png_set_write_fn(png, &sink, append, noFlush);
    png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), bits,
                 alpha ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_set_compression_level(png, level);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
    png_write_info(png, info);
    const std::size_t row = (alpha ? 4U : 3U) * static_cast<std::size_t>(width);
    for (int y = 0; y < height; ++y) png_write_row(png, pixels + static_cast<std::size_t>(y) * row);
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    return true;
}

}  // namespace

std::vector<std::byte> encodePng(int width, int height, std::span<const std::uint8_t> pixels) {
    assert(width > 0 && height > 0);
    const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    const bool alpha = pixels.size() == 4 * count;
    assert(alpha || pixels.size() == 3 * count);
    Sink sink;
    if (!encode(sink, width, height, alpha, pixels.data()))
        throw Error("cannot encode the picture: " + sink.error, "", "");
    return std::move(sink.bytes);
}

void writePng(const std::filesystem::path& path, int width, int height, std::span<const std::uint8_t> pixels) {
    writeFile(path, encodePng(width, height, pixels));
}

}  // namespace lumulus
