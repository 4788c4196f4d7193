#include "base/tonemap.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace lumulus {
namespace {

/// The filmic curve of Narkowicz 2015 for x ≥ 0. The clamp keeps x² finite; the curve is flat long before.
double filmic(double x) {
    x = std::min(x, 1e6);
    return std::min(1.0, x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14));
}

double srgb(double linear) {
    if (linear >= 1.0) return 1.0;  // exactly: rounding would dither white
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

/// Interleaved gradient noise (Jimenez 2014), in [0,1): breaks the bands of a smooth sky without visible texture.
double ditherAt(int x, int y) {
    const double inner = 0.06711056 * x + 0.00583715 * y;
    const double outer = 52.9829189 * (inner - std::floor(inner));
    return outer - std::floor(outer);
}

std::uint8_t encode(double radiance, double dither) {
    if (!(radiance > 0.0)) return 0;  // NaN too
    return static_cast<std::uint8_t>(std::min(255.0, std::floor(255.0 * srgb(filmic(radiance)) + dither)));
}

}  // namespace

std::vector<std::uint8_t> toneMap(const LayeredImage& image, double exposureStops) {
    const double gain = std::exp2(exposureStops);
    const std::array<const float*, 3> channels{image.layers.at("R").data(), image.layers.at("G").data(),
                                               image.layers.at("B").data()};
    std::vector<std::uint8_t> rgb(image.pixels() * 3);
    std::size_t pixel = 0;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x, ++pixel) {
            const double dither = ditherAt(x, y);
            for (std::size_t c = 0; c < 3; ++c) {
                rgb[pixel * 3 + c] = encode(gain * static_cast<double>(channels[c][pixel]), dither);
            }
        }
    }
    return rgb;
}

}  // namespace lumulus
