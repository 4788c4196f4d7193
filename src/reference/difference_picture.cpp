#include "reference/difference_picture.h"

#include <algorithm>
#include <cmath>

namespace lumulus::reference {
namespace {

/// Rec. 709 luminance of every pixel.
std::vector<double> luminance(const LayeredImage& image) {
    const auto& red = image.layers.at("R");
    const auto& green = image.layers.at("G");
    const auto& blue = image.layers.at("B");
    std::vector<double> result(image.pixels());
    for (std::size_t i = 0; i < result.size(); ++i) {
        result[i] = 0.2126 * static_cast<double>(red[i]) + 0.7152 * static_cast<double>(green[i]) +
                    0.0722 * static_cast<double>(blue[i]);
    }
    return result;
}

}  // namespace

std::vector<std::uint8_t> differencePicture(const LayeredImage& image, const LayeredImage& reference) {
    const std::vector<double> ours = luminance(image), truth = luminance(reference);
    double mean = 0.0;
    for (const double value : truth) mean += value / static_cast<double>(truth.size());
    std::vector<std::uint8_t> rgb;
    rgb.reserve(3 * ours.size());
    for (std::size_t i = 0; i < ours.size(); ++i) {
        const double scale = std::abs(truth[i]) + 0.01 * std::abs(mean);
        const double relative = scale > 0.0 ? (ours[i] - truth[i]) / scale : 0.0;
        const double strength = std::sqrt(std::min(1.0, std::abs(relative)));
        const auto faded = static_cast<std::uint8_t>(std::lround(255.0 * (1.0 - strength)));
        // the far end of each side is a full blue or red; the others fade
        const std::uint8_t full = 255;
        rgb.insert(rgb.end(), {relative < 0.0 ? faded : full, faded, relative > 0.0 ? faded : full});
    }
    return rgb;
}

}  // namespace lumulus::reference
