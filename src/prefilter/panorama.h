#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace lumulus::prefilter {

/// Radiance by latitude and longitude, rows from the zenith (+Y) down: +X in the middle of the width, +Z a quarter of
/// it to the right. Blender and three.js show such pictures unrotated. Pixels are areas: the middle of pixel (x, y) is
/// at (x + ½) / width, (y + ½) / height.
struct Panorama {
    int width = 0, height = 0;
    std::vector<glm::vec3> pixels;

    /// Towards a point of the picture, 0 to width and 0 to height: a unit vector.
    glm::dvec3 direction(double x, double y) const;
    /// Of a pixel in row y [sr]. Those of all pixels add up to 4π.
    double solidAngle(int y) const;
    /// Bilinear between the middles of pixels, in longitude all around.
    glm::vec3 at(const glm::dvec3& direction) const;
};

/// A panorama of three layers of width × height values. Values that are no radiance (NaN, infinite, below 0) become 0.
Panorama panoramaOf(int width, int height, std::span<const float> red, std::span<const float> green,
                    std::span<const float> blue);

}  // namespace lumulus::prefilter
