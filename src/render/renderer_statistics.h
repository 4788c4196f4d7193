#pragma once

#include <vector>

#include "gpu/commands.h"
#include "light/photon/photon_map.h"
#include "render/renderer.h"

/// What a renderer tells of its work.
namespace lumulus {

/// Adds the times of passes to those of the same names.
void addTimes(Statistics& statistics, const std::vector<gpu::PassTime>& times);

/// With what its photons tell, which may be null, and the warnings that follow from it.
Statistics finished(Statistics statistics, const photon::PhotonMap* photons);

}  // namespace lumulus
