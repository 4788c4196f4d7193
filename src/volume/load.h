#pragma once

#include <string>
#include <vector>

#include "base/progress.h"
#include "scene/scene.h"
#include "vdb/volume.h"

namespace lumulus {

/// The density of a scene's cloud, with what there is to warn of.
struct CloudVolume {
    vdb::Volume volume;
    std::vector<std::string> warnings;
};

/// Loads or makes the cloud, its transform applied. `memoryBudget` in MiB. Errors: InputError for bad grids, Error
/// where interrupted.
CloudVolume loadCloudVolume(const scene::Cloud& cloud, double memoryBudget, const Report& report = noReport);

}  // namespace lumulus
