#pragma once

#include <vector>

#include "gpu/program.h"
#include "light/photon/photon_map.h"

namespace lumulus::photon {

/// Constants of the programs of photons, by what is around the clouds: `constants` and those of ground, fog
/// and the cells of the sky, and of meshes where photons begin in the program (`starts`).
std::vector<gpu::SpecConstant> withSurroundings(std::vector<gpu::SpecConstant> constants, const Options& options,
                                                bool starts = false);

}  // namespace lumulus::photon
