#pragma once

#include <optional>
#include <vector>

#include "scene/scene.h"

namespace lumulus::reference {

/// Radius of the planet below an atmosphere, metres.
inline constexpr double planetRadius = 6360e3;

/// The ground of a scene: that of its own, or the planet's at y = 0 where the sky is an atmosphere.
std::optional<scene::Ground> groundOf(const scene::Scene& scene);

/// The opaque surfaces of a scene, and after them its ground: an infinite plane, or a sphere of the planet's radius
/// below an atmosphere.
std::vector<scene::Surface> surfacesOf(const scene::Scene& scene);

}  // namespace lumulus::reference
