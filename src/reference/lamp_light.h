#pragma once

#include <glm/glm.hpp>

#include "scene/lamp.h"

namespace lumulus::reference {

/// What a lamp of the scene sends into each direction.
class LampLight {
  public:
    explicit LampLight(const scene::Lamp& lamp);

    /// Radiant intensity over the lamp's power in a direction away from it, 1/sr; its integral over all is 1.
    double share(const glm::dvec3& direction) const;

    /// Radiance of each point of its surface in that direction, W·m⁻²·sr⁻¹.
    glm::dvec3 radiance(const glm::dvec3& direction) const { return share(direction) * radiancePerShare_; }

    /// Largest share, 1/sr.
    double largestShare() const { return brightest_; }

    /// Whether light may leave within `slack` radians of a direction.
    bool reaches(const glm::dvec3& direction, double slack) const;

  private:
    scene::LampKind kind_;
    glm::dvec3 axis_;
    glm::dvec3 level_{0.0}, rising_{0.0};  ///< pyramid: unit vectors square to two sides each
    double halfAngle_;                     ///< radians
    double widest_;                        ///< largest angle to the axis, radians
    double innerEdge_, outerEdge_;         ///< where fading begins and ends: of `edgeOf`
    double brightest_;
    glm::dvec3 radiancePerShare_;
};

}  // namespace lumulus::reference
