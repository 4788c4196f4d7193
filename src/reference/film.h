#pragma once

#include <bit>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "base/image.h"

namespace lumulus::reference {

/// Sums over the samples of one pixel, in double. They are taken in the order of the samples, so that their bits do not
/// depend on how the work is divided.
struct PixelSums {
    glm::dvec3 scattered{0.0};      ///< radiance except that of the sky and sun directly behind
    glm::dvec3 square{0.0};         ///< squares of the whole radiance
    glm::dvec3 passed{0.0};         ///< radiance of the sky directly behind, in Environment::unit
    glm::dvec3 disc{0.0};           ///< what is seen of the sun's disc over its unit, times its share of the pixel
    double discShare = 0.0;         ///< that share
    glm::dvec3 transmittance{0.0};  ///< of cloud, fog and surfaces
    double clear = 0.0;             ///< transmittance of cloud and surfaces alone
    double distance = 0.0;          ///< to cloud and surfaces, weighted by their opacity: ∫ t T σt dt, metres

    bool operator==(const PixelSums&) const = default;
};

/// An unfinished picture with everything that is needed to continue it.
struct Film {
    int width = 0;
    int height = 0;
    std::uint64_t samples = 0;  ///< of every pixel
    std::uint64_t lost = 0;     ///< paths that met the limit of collisions
    double seconds = 0.0;       ///< spent so far
    std::vector<PixelSums> pixels;

    bool operator==(const Film&) const = default;
};

/// True for samples that also measure transmittance and distance: those whose number, counted from 1, is a power of
/// two. The only noise of these quantities is the place within the pixel, so few samples are enough.
inline bool isLineSample(std::uint64_t sample) {
    return std::has_single_bit(sample + 1);
}

/// Depth of a pixel without cloud and surface, metres.
constexpr double farDepth = 1e10;

/// The means as layers: R, G, B; A (1, or cloud.A where the samples leave the background out); cloud.{R,G,B} (all light
/// except the sky and sun directly behind), transmittance.{R,G,B} (of cloud, fog and surfaces; cloud.A is 1 less their
/// mean), depth.Z (of cloud and surfaces; fog has no depth), from two samples on variance.{R,G,B} (of the mean of R, G,
/// B, not of a sample), and sun.disc, the share of the pixel that the sun's disc covers, where it is in the picture.
/// `skyUnit` is Environment::unit and `disc` what the sums of the disc count in. At least one sample.
LayeredImage picture(const Film& film, const glm::dvec3& skyUnit, const glm::dvec3& disc, bool background);

}  // namespace lumulus::reference
