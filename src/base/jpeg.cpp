#include "base/jpeg.h"

#include <cassert>
#include <cstdio>  // jpeglib.h needs FILE
#include <cstdlib>

#include <jpeglib.h>

#include "base/error.h"

namespace lumulus {
namespace {

/// libjpeg expects that this function does not return. It throws, and the compressor is destroyed while unwinding.
void onError(j_common_ptr info) {
    char text[JMSG_LENGTH_MAX];
    (*info->err->format_message)(info, text);
    throw Error(std::string("cannot encode the picture: ") + text, "", "");
}

class Compressor {
  public:
    Compressor() {
        info.err = jpeg_std_error(&errors_);
        errors_.error_exit = onError;
        jpeg_create_compress(&info);
        jpeg_mem_dest(&info, &data_, &size_);
    }
    Compressor(const Compressor&) = delete;
    Compressor& operator=(const Compressor&) = delete;
    ~Compressor() {
        jpeg_destroy_compress(&info);
        std::free(data_);
    }
    std::vector<std::byte> bytes() const {
        const auto all = std::as_bytes(std::span(data_, size_));
        return {all.begin(), all.end()};
    }

    jpeg_compress_struct info{};

  private:
    jpeg_error_mgr errors_{};
    unsigned char* data_ = nullptr;
    unsigned long size_ = 0;
};

}  // namespace

std::vector<std::byte> encodeJpeg(int width, int height, std::span<const std::uint8_t> rgb, int quality) {
    const std::size_t row = static_cast<std::size_t>(width) * 3;
    assert(width > 0 && height > 0 && rgb.size() == row * static_cast<std::size_t>(height));
    Compressor compressor;
    jpeg_compress_struct& info = compressor.info;
    info.image_width = static_cast<JDIMENSION>(width);
    info.image_height = static_cast<JDIMENSION>(height);
    info.input_components = 3;
    info.in_color_space = JCS_RGB;
    jpeg_set_defaults(&info);
    jpeg_set_quality(&info, quality, TRUE);
    jpeg_start_compress(&info, TRUE);
    while (info.next_scanline < info.image_height) {
        // the library only reads through this pointer, although its type is mutable
        JSAMPROW line = const_cast<JSAMPROW>(rgb.data() + info.next_scanline * row);
        jpeg_write_scanlines(&info, &line, 1);
    }
    jpeg_finish_compress(&info);
    return compressor.bytes();
}

}  // namespace lumulus
