#pragma once

#include <glm/glm.hpp>
#include <span>

#include "lamp/light_path.h"
#include "lamp/once_scattered.h"

namespace lumulus::lamp {

/// A lamp beside a ray.
struct PassedBeam {
    const Beam* beam = nullptr;
    double miss = 0.0;  ///< distance at which the ray passes it, as onceScattered() has it [m]
};

/// What a ray sees among clouds.
struct SeenAmongClouds {
    glm::dvec3 light{0.0};  ///< of lamps, scattered once by fog and clouds [W/(m² sr)]
    double clear = 1.0;     ///< transmittance of the clouds
};

/// Light of lamps that is scattered once, by fog or by clouds, along a ray up to `metres`. Within clouds the ray is cut
/// into steps of a voxel; each sends its light from where the mean of what it sends comes from.
SeenAmongClouds scatteredAmongClouds(const Around& around, std::span<const PassedBeam> beams, const Ray& ray,
                                     double metres);

}  // namespace lumulus::lamp
