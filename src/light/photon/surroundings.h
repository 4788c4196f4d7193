#pragma once

#include <vector>

#include "gpu/program.h"
#include "light/photon/photon_map.h"

namespace lumulus::photon {

/// Constants of the programs in which photons begin, by what is around the clouds: `constants` and those of ground, fog
/// and the cells of the sky.
std::vector<gpu::SpecConstant> withSurroundings(std::vector<gpu::SpecConstant> constants, const Options& options);

}  // namespace lumulus::photon
