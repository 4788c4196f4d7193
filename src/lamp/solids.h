#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <optional>

#include "view/camera.h"

namespace lumulus::lamp {

/// Where a ray meets a surface.
struct SolidMeeting {
    double metres = 0.0;
    glm::dvec3 normal{0.0, 1.0, 0.0};  ///< unit vector on the side that the ray comes from
    glm::dvec3 albedo{0.0};            ///< of a matte surface that sends back as much
};

/// Solid bodies in the light of lamps. Places are in the world, metres.
struct Solids {
    glm::dvec3 middle{0.0};  ///< of a sphere around all
    double radius = 0.0;
    std::function<std::optional<double>(const Ray&, double metres)> distance{};    ///< of the first up to `metres`
    std::function<std::optional<SolidMeeting>(const Ray&, double metres)> meet{};  ///< the same with what is there

    /// Distance at which a ray meets one, `metres` where it does not before.
    double end(const Ray& ray, double metres) const { return distance(ray, metres).value_or(metres); }
};

}  // namespace lumulus::lamp
