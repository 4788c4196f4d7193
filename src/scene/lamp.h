#pragma once

#include <glm/glm.hpp>
#include <string>

namespace lumulus::scene {

enum class LampKind { point, spot, pyramid };

/// A sphere that gives off light: from each point of its surface the same radiance in a direction, and another one in
/// another direction. Seen from afar it has the radiant intensity I(ω) = π · radius² · radiance(ω), whose integral over
/// all directions is `power`. A point has one intensity for all directions; a spot lights a circular cone, a pyramid
/// one with a square section, two sides of which are level.
struct Lamp {
    std::string name;  ///< empty: its index
    LampKind kind = LampKind::point;
    glm::dvec3 position{0.0};
    glm::dvec3 direction{0.0, -1.0, 0.0};  ///< spot, pyramid: unit vector along the axis, away from the lamp
    double angle = 60.0;    ///< spot, pyramid: between opposite sides, degrees; at 180 half of all directions
    double softness = 0.0;  ///< spot, pyramid: share of the half angle over which the light fades
    double radius = 0.1;    ///< metres
    glm::dvec3 power{0.0};  ///< over all directions that it lights, W per channel
    bool on = true;

    bool shines() const { return on && (power.x > 0.0 || power.y > 0.0 || power.z > 0.0); }
    bool operator==(const Lamp&) const = default;
};

}  // namespace lumulus::scene
