#include "base/tonemap.h"

#include <tbb/parallel_for.h>

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

std::vector<std::uint8_t> toneMapWithAlpha(const LayeredImage& image, double exposureStops) {
    LayeredImage straight;
    straight.width = image.width;
    straight.height = image.height;
    const std::vector<float>& alpha = image.layers.at("A");
    for (const char* name : {"R", "G", "B"}) {
        std::vector<float>& colour = straight.layer(name);
        const std::vector<float>& premultiplied = image.layers.at(name);
        for (std::size_t i = 0; i < colour.size(); ++i)
            colour[i] = alpha[i] > 0.0F ? premultiplied[i] / alpha[i] : 0.0F;
    }
    const std::vector<std::uint8_t> rgb = toneMap(straight, exposureStops);
    std::vector<std::uint8_t> rgba(image.pixels() * 4);
    for (std::size_t i = 0; i < alpha.size(); ++i) {
        std::copy_n(&rgb[3 * i], 3, &rgba[4 * i]);
        const float cover = alpha[i] > 0.0F ? std::min(alpha[i], 1.0F) : 0.0F;  // NaN too
        rgba[4 * i + 3] = static_cast<std::uint8_t>(std::lround(255.0F * cover));
    }
    return rgba;
}

std::vector<std::uint8_t> toneMap(const LayeredImage& image, double exposureStops) {
    const double gain = std::exp2(exposureStops);
    const std::array<const float*, 3> channels{image.layers.at("R").data(), image.layers.at("G").data(),
                                               image.layers.at("B").data()};
    std::vector<std::uint8_t> rgb(image.pixels() * 3);
    tbb::parallel_for(0, image.height, [&](int y) {
        std::size_t pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width);
        for (int x = 0; x < image.width; ++x, ++pixel) {
            const double dither = ditherAt(x, y);
            for (std::size_t c = 0; c < 3; ++c)
                rgb[pixel * 3 + c] = encode(gain * static_cast<double>(channels[c][pixel]), dither);
        }
    });
    return rgb;
}

}  // namespace lumulus
