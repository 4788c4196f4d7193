#pragma once

#include <string>

#include "render/world.h"

namespace lumulus {

/// SHA-256, in hexadecimal digits, of all that the counts of a generation depend on besides its number: densities,
/// collectors, cells, media, lights, ground, fog, seed, photons of a generation and the version. What only a picture
/// depends on (its camera and size, where no cloud is coarser for its size in it) leaves it as it is.
std::string lightFingerprint(gpu::Context& context, const World& world, const scene::Scene& scene);

}  // namespace lumulus
