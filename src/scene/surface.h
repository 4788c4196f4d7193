#pragma once

#include <glm/glm.hpp>

/// Opaque surfaces that can be intersected in closed form, for `lumulus reference` only.
namespace lumulus::scene {

enum class SurfaceKind { plane, sphere, disc };

/// A diffuse (Lambert) and emissive surface, the same on both sides.
struct Surface {
    SurfaceKind kind = SurfaceKind::plane;
    glm::dvec3 position{0.0};          ///< a point of the plane; the middle of a sphere or disc. Metres
    glm::dvec3 normal{0.0, 1.0, 0.0};  ///< plane, disc: unit vector
    double radius = 100.0;             ///< sphere, disc: metres
    glm::dvec3 albedo{0.5};            ///< share of the light that is reflected, RGB
    glm::dvec3 emission{0.0};          ///< radiance, W·m⁻²·sr⁻¹, RGB

    bool operator==(const Surface&) const = default;
};

}  // namespace lumulus::scene
