#include "base/png.h"

#include <png.h>

#include <cassert>
#include <cstddef>

#include "base/atomic_file.h"
#include "base/error.h"

namespace lumulus {

std::vector<std::byte> encodePng(int width, int height, std::span<const std::uint8_t> pixels) {
    assert(width > 0 && height > 0);
    const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    const bool alpha = pixels.size() == 4 * count;
    assert(alpha || pixels.size() == 3 * count);
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = static_cast<png_uint_32>(width);
    image.height = static_cast<png_uint_32>(height);
    image.format = alpha ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB;
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
    std::vector<std::byte> bytes(size);
    if (png_image_write_to_memory(&image, bytes.data(), &size, 0, pixels.data(), 0, nullptr) == 0) {
        throw Error(std::string("cannot encode the picture: ") + image.message, "", "");
    }
    bytes.resize(size);
    return bytes;
}

void writePng(const std::filesystem::path& path, int width, int height, std::span<const std::uint8_t> pixels) {
    writeFile(path, encodePng(width, height, pixels));
}

}  // namespace lumulus
