#include "progressive/noise.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace lumulus::progressive {

namespace {

/// Indices of the pixels that show the cloud.
std::vector<std::size_t> cloudPixels(const Preview& preview) {
    const auto& red = preview.even.layers.at("transmittance.R");
    const auto& green = preview.even.layers.at("transmittance.G");
    const auto& blue = preview.even.layers.at("transmittance.B");
    const auto width = static_cast<std::size_t>(preview.even.width);
    std::vector<std::size_t> pixels;
    for (const int row : preview.rows)
        for (std::size_t i = static_cast<std::size_t>(row) * width; i < (static_cast<std::size_t>(row) + 1) * width;
             ++i)
            if (std::min({red[i], green[i], blue[i]}) < 0.999F) pixels.push_back(i);
    return pixels;
}

}  // namespace

double noiseOf(const Preview& preview, int generations) {
    const double even = preview.evenGenerations, odd = preview.oddGenerations;
    const std::vector<std::size_t> pixels = cloudPixels(preview);
    std::vector<double> radiances, squares;
    double mean = 0.0;
    for (const char* colour : {"R", "G", "B"}) {
        const std::vector<float>& a = preview.even.layers.at(colour);
        const std::vector<float>& b = preview.odd.layers.at(colour);
        for (const std::size_t i : pixels) {
            const auto first = static_cast<double>(a[i]), second = static_cast<double>(b[i]);
            radiances.push_back((even * first + odd * second) / (even + odd));
            squares.push_back((first - second) * (first - second));
            mean += radiances.back();
        }
    }
    if (!(mean > 0.0)) return 0.0;
    const auto count = static_cast<double>(radiances.size());
    mean /= count;
    double sum = 0.0;
    for (std::size_t i = 0; i < radiances.size(); ++i)
        sum += squares[i] / (radiances[i] * radiances[i] + 0.01 * mean * mean);
    return sum / count * even * odd / ((even + odd) * generations);
}

}  // namespace lumulus::progressive
