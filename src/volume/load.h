#pragma once

#include <string>
#include <vector>

#include "base/progress.h"
#include "scene/scene.h"
#include "vdb/volume.h"

namespace lumulus {

/// The density of a scene's cloud, with warnings.
struct CloudVolume {
    vdb::Volume volume;
    std::vector<std::string> warnings;
};

/// Loads or makes the cloud and applies its transform. `memoryBudget` is in MiB. Errors: InputError for bad grids,
/// Error if interrupted.
CloudVolume loadCloudVolume(const scene::Cloud& cloud, double memoryBudget, const Report& report = noReport);

}  // namespace lumulus
