#include "base/tonemap.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "base/display_transform.h"

namespace lumulus {
namespace {

/// Interleaved gradient noise (Jimenez 2014), in [0,1): breaks the bands of a smooth sky without visible texture.
double ditherAt(int x, int y) {
    const double inner = 0.06711056 * x + 0.00583715 * y;
    const double outer = 52.9829189 * (inner - std::floor(inner));
    return outer - std::floor(outer);
}

std::uint8_t quantised(double encoded, double dither) {
    return static_cast<std::uint8_t>(std::min(255.0, std::floor(255.0 * encoded + dither)));
}

/// Encoded values of a row of pixels, three a pixel, in [0,1].
void encodeRow(const Tone& tone, std::vector<Colour>& row) {
    if (tone.display != nullptr) return tone.display->apply(row);
    for (Colour& colour : row) colour = displayed(tone.curve, colour);
}

}  // namespace

double Tone::factor() const {
    return std::exp2(stops) * gain;
}

std::vector<std::uint8_t> toneMapWithAlpha(const LayeredImage& image, const Tone& tone) {
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
    const std::vector<std::uint8_t> rgb = toneMap(straight, tone);
    std::vector<std::uint8_t> rgba(image.pixels() * 4);
    for (std::size_t i = 0; i < alpha.size(); ++i) {
        std::copy_n(&rgb[3 * i], 3, &rgba[4 * i]);
        const float cover = alpha[i] > 0.0F ? std::min(alpha[i], 1.0F) : 0.0F;  // NaN too
        rgba[4 * i + 3] = static_cast<std::uint8_t>(std::lround(255.0F * cover));
    }
    return rgba;
}

std::vector<std::uint8_t> toneMap(const LayeredImage& image, const Tone& tone) {
    const double gain = tone.factor();
    const std::array<const float*, 3> channels{image.layers.at("R").data(), image.layers.at("G").data(),
                                               image.layers.at("B").data()};
    const auto width = static_cast<std::size_t>(image.width);
    std::vector<std::uint8_t> rgb(image.pixels() * 3);
    tbb::parallel_for(0, image.height, [&](int y) {
        const std::size_t first = static_cast<std::size_t>(y) * width;
        std::vector<Colour> row(width);
        for (std::size_t x = 0; x < width; ++x)
            for (std::size_t c = 0; c < 3; ++c) row[x][c] = gain * static_cast<double>(channels[c][first + x]);
        encodeRow(tone, row);
        for (std::size_t x = 0; x < width; ++x) {
            const double dither = ditherAt(static_cast<int>(x), y);
            for (std::size_t c = 0; c < 3; ++c) rgb[(first + x) * 3 + c] = quantised(row[x][c], dither);
        }
    });
    return rgb;
}

std::vector<std::uint8_t> toneMap(const LayeredImage& image, double exposureStops) {
    return toneMap(image, Tone{exposureStops});
}

}  // namespace lumulus
