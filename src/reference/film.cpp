#include "reference/film.h"

#include <array>
#include <bit>
#include <cassert>
#include <string>

namespace lumulus::reference {
namespace {

constexpr std::array<const char*, 3> channels{"R", "G", "B"};

using Layers = std::array<float*, 3>;

Layers layersOf(LayeredImage& image, const std::string& prefix) {
    Layers layers{};
    for (std::size_t c = 0; c < 3; ++c) layers[c] = image.layer(prefix + channels[c]).data();
    return layers;
}

void put(const Layers& layers, std::size_t pixel, const glm::dvec3& value) {
    for (std::size_t c = 0; c < 3; ++c) layers[c][pixel] = static_cast<float>(value[static_cast<int>(c)]);
}

/// Variance of the mean from the mean of squares and the mean of n samples. A difference by rounding counts as 0.
glm::dvec3 varianceOfMean(const glm::dvec3& square, const glm::dvec3& mean, double n) {
    constexpr double rounding = 1e-13;
    const glm::dvec3 variance = square - mean * mean;
    return glm::mix(glm::dvec3(0.0), variance / (n - 1.0), glm::greaterThan(variance, rounding * square));
}

/// Mean of the three channels; exactly their value where they are equal.
double meanOf(const glm::dvec3& rgb) {
    return rgb.x + ((rgb.y - rgb.x) + (rgb.z - rgb.x)) / 3.0;
}

void putLines(const Film& film, LayeredImage& image) {
    const auto count = static_cast<double>(std::bit_width(film.samples));  // powers of two up to the samples
    const Layers transmittance = layersOf(image, "transmittance.");
    float* alpha = image.layer("cloud.A").data();
    float* depth = image.layer("depth.Z").data();
    for (std::size_t i = 0; i < film.pixels.size(); ++i) {
        const PixelSums& sums = film.pixels[i];
        put(transmittance, i, sums.transmittance / count);
        alpha[i] = static_cast<float>((count - meanOf(sums.transmittance)) / count);
        const double hidden = count - sums.clear;
        depth[i] = static_cast<float>(hidden > 0.0 ? sums.distance / hidden : farDepth);
    }
}

}  // namespace

LayeredImage picture(const Film& film, const glm::dvec3& skyUnit, const glm::dvec3& disc, bool background) {
    assert(film.samples > 0);
    LayeredImage image;
    image.width = film.width;
    image.height = film.height;
    const auto n = static_cast<double>(film.samples);
    const Layers radiance = layersOf(image, ""), cloud = layersOf(image, "cloud.");
    const Layers variance = film.samples > 1 ? layersOf(image, "variance.") : Layers{};
    for (std::size_t i = 0; i < film.pixels.size(); ++i) {
        const PixelSums& sums = film.pixels[i];
        const glm::dvec3 mean = (sums.scattered + sums.passed * skyUnit + sums.disc * disc) / n;
        put(radiance, i, mean);
        put(cloud, i, sums.scattered / n);
        if (film.samples > 1) put(variance, i, varianceOfMean(sums.square / n, mean, n));
        if (sums.discShare > 0.0) image.layer("sun.disc")[i] = static_cast<float>(sums.discShare / n);
    }
    putLines(film, image);
    std::vector<float>& alpha = image.layer("A", 1.0F);
    if (!background) alpha = image.layers.at("cloud.A");
    return image;
}

}  // namespace lumulus::reference
