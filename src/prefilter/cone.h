#pragma once

#include <array>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "base/interrupt.h"
#include "prefilter/cube_map.h"

/// The method of Moschos (2017), 3.3.3: random samples in a cone as wide as the lobe of Beckmann's distribution.
namespace lumulus::prefilter {

/// Roughness and half the angle of the cone [degrees] of a level (figure 3.24).
struct ConeLevel {
    double roughness = 0.0, angle = 0.0;
};

inline constexpr std::array<ConeLevel, 11> coneLevels{{{0.0, 0.0},
                                                       {0.01, 1.0},
                                                       {0.05, 6.0},
                                                       {0.1, 12.0},
                                                       {0.2, 23.0},
                                                       {0.3, 32.0},
                                                       {0.4, 40.0},
                                                       {0.5, 47.0},
                                                       {0.6, 52.0},
                                                       {0.7, 56.0},
                                                       {1.0, 65.0}}};

/// Means over cones around directions (unit vectors), by 200 samples each that are uniform on the base of the cone and
/// weighted by their cosine, each read at the finest level. The thesis multiplies the sum by the area of the base,
/// which makes a white sky 0.001 to 14.4; here the weights add up to 1. Random numbers are a hash of direction and
/// sample. Errors: what `check` throws, on any thread.
std::vector<glm::vec3> coneMeans(const CubeMap& map, double angle, std::span<const glm::vec3> directions,
                                 const Check& check);

}  // namespace lumulus::prefilter
