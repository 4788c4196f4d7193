#pragma once

#include <vector>

#include "render/world.h"
#include "scene/scene.h"

namespace lumulus {

/// Of the photons, how many begin round each visible instance: by what the picture of the scene's camera shows of it
/// and of those near it, which it lights; a fifth by the light that falls on it. `equally`: for viewers anywhere. Sums
/// up to 1, and no share is 0.
std::vector<double> photonShares(const World& world, const std::vector<std::size_t>& visible, const scene::Scene& scene,
                                 bool equally);

}  // namespace lumulus
