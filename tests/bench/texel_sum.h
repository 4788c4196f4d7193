#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "prefilter/panorama.h"

namespace lumulus::bench {

/// The plain way to filter a map by GGX, and the truth for others: for each direction the sum over all texels, each at
/// its middle. `alpha` > 0. Its own formulas.
std::vector<glm::vec3> texelSum(const prefilter::Panorama& panorama, double alpha,
                                std::span<const glm::vec3> directions);

/// The panorama with a half, a quarter, … of the pixels along each side: means by solid angle.
prefilter::Panorama reduced(const prefilter::Panorama& panorama, int times);

/// Root of the mean square of the errors over that of the truth, all channels together.
double relativeError(std::span<const glm::vec3> values, std::span<const glm::vec3> truth);

/// What a viewer reads of a cube map in OpenEXR's layout: linear between the four pixels about a direction.
glm::vec3 readCube(std::span<const glm::vec3> pixels, int size, const glm::vec3& direction);

/// Directions all around, as evenly as they may be (spherical Fibonacci).
std::vector<glm::vec3> evenDirections(int count);

/// A sky without its sun, from this elevation of it [degrees]: of an atmosphere above a ground.
prefilter::Panorama clearSky(double elevation, int height);

}  // namespace lumulus::bench
