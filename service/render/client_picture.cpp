#include "service/render/client_picture.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "service/values/request_error.h"

namespace lumulus::service {

std::vector<float> readPixels(const Composite& composite, LayeredImage& picture) {
    static_assert(std::endian::native == std::endian::little);
    const std::size_t pixels = composite.pixels.size() / (4 * sizeof(float));
    std::vector<float> color(3 * pixels), depth(pixels);
    std::memcpy(color.data(), composite.pixels.data(), color.size() * sizeof(float));
    std::memcpy(depth.data(), composite.pixels.data() + color.size() * sizeof(float), depth.size() * sizeof(float));
    const auto isFinite = [](float x) { return std::isfinite(x); };
    if (!std::ranges::all_of(color, isFinite) || !std::ranges::all_of(depth, isFinite))
        throw RequestError("bad_request", "colour and depth must be finite numbers");
    picture.width = composite.width;
    picture.height = composite.height;
    picture.layer("A", 1.0F);
    const char* names[3] = {"R", "G", "B"};
    for (std::size_t channel = 0; channel < 3; ++channel) {
        std::vector<float>& layer = picture.layer(names[channel]);
        for (std::size_t i = 0; i < layer.size(); ++i) layer[i] = color[3 * i + channel];
    }
    return depth;
}

}  // namespace lumulus::service
