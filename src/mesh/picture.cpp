#include "mesh/picture.h"

#include <fmt/format.h>
#include <png.h>

#include <csetjmp>
#include <cstdio>  // jpeglib.h needs it

#include <jpeglib.h>

#include <cstring>
#include <utility>

#include "base/error.h"
#include "mesh/gltf_file.h"

namespace lumulus::mesh {
namespace {

constexpr std::size_t mostPixels = std::size_t{1} << 26U;
constexpr const char* mend = "give the picture as PNG or JPEG";

/// What goes wrong in a library.
struct Fault {
    std::string what;
};

void sizeFor(Texture& texture, std::size_t width, std::size_t height) {
    if (width == 0 || height == 0) throw Fault{fmt::format("has {} × {} pixels", width, height)};
    if (width > mostPixels / height) throw Fault{fmt::format("has {} × {} pixels, more than 2^26", width, height)};
    texture.width = static_cast<int>(width);
    texture.height = static_cast<int>(height);
    texture.texels.resize(width * height);
}

Texture decodePng(std::span<const unsigned char> bytes) {
    Texture texture;
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    const auto check = [&](int done) {
        if (done != 0) return;
        const std::string what = fmt::format("cannot be read as PNG: {}", image.message);
        png_image_free(&image);
        throw Fault{what};
    };
    check(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()));
    image.format = PNG_FORMAT_RGBA;
    try {
        sizeFor(texture, image.width, image.height);
    } catch (const Fault&) {
        png_image_free(&image);
        throw;
    }
    check(png_image_finish_read(&image, nullptr, texture.texels.data(), 0, nullptr));
    return texture;
}

/// libjpeg reports by a jump out of its functions.
struct Jump {
    jpeg_error_mgr errors;
    std::jmp_buf out;
    char message[JMSG_LENGTH_MAX];
};

void jumpOut(j_common_ptr info) {
    Jump* jump = reinterpret_cast<Jump*>(info->err);
    (*info->err->format_message)(info, jump->message);
    std::longjmp(jump->out, 1);
}

/// Reads the rows of a JPEG into `texture`, which owns its memory outside of this function. Returns false where the
/// library has jumped out; `tooLarge` where it was not begun.
bool readJpeg(std::span<const unsigned char> bytes, Texture& texture, std::vector<unsigned char>& row, Jump& jump,
              std::string& fault) {
    jpeg_decompress_struct info;
    info.err = jpeg_std_error(&jump.errors);
    jump.errors.error_exit = jumpOut;
    jump.errors.output_message = [](j_common_ptr) {};
    if (setjmp(jump.out) != 0) {
        jpeg_destroy_decompress(&info);
        return false;
    }
    jpeg_create_decompress(&info);
    jpeg_mem_src(&info, bytes.data(), static_cast<unsigned long>(bytes.size()));
    jpeg_read_header(&info, TRUE);
    info.out_color_space = JCS_RGB;
    try {
        sizeFor(texture, info.image_width, info.image_height);
        row.resize(std::size_t{3} * info.image_width);
    } catch (const Fault& e) {
        fault = e.what;
    }
    if (fault.empty()) {
        jpeg_start_decompress(&info);
        while (info.output_scanline < info.output_height) {
            auto* texel = texture.texels.data() + std::size_t{info.output_scanline} * info.image_width;
            unsigned char* rows[1] = {row.data()};
            jpeg_read_scanlines(&info, rows, 1);
            for (std::size_t x = 0; x < info.image_width; ++x)
                texel[x] = {row[3 * x], row[3 * x + 1], row[3 * x + 2], 255};
        }
        jpeg_finish_decompress(&info);
    }
    jpeg_destroy_decompress(&info);
    return true;
}

Texture decodeJpeg(std::span<const unsigned char> bytes) {
    Texture texture;
    std::vector<unsigned char> row;
    Jump jump{};
    std::string fault;
    if (!readJpeg(bytes, texture, row, jump, fault))
        throw Fault{fmt::format("cannot be read as JPEG: {}", jump.message)};
    if (!fault.empty()) throw Fault{fault};
    return texture;
}

}  // namespace

Texture decodePicture(const std::filesystem::path& file, const std::string& name,
                      std::span<const unsigned char> bytes) {
    constexpr unsigned char pngStart[4] = {0x89, 'P', 'N', 'G'}, jpegStart[2] = {0xFF, 0xD8};
    const auto begins = [&](const unsigned char* with, std::size_t count) {
        return bytes.size() >= count && std::memcmp(bytes.data(), with, count) == 0;
    };
    try {
        if (begins(pngStart, sizeof(pngStart))) return decodePng(bytes);
        if (begins(jpegStart, sizeof(jpegStart))) return decodeJpeg(bytes);
    } catch (const Fault& e) {
        failGltf(file, name + " " + e.what, mend);
    }
    failGltf(file, name + (bytes.empty() ? " cannot be read" : " is no PNG or JPEG"), mend);
}

}  // namespace lumulus::mesh
