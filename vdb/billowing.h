#pragma once

#include <cstdint>
#include <vector>

#include "base/progress.h"
#include "vdb/puffs.h"
#include "vdb/volume.h"

/// Water clouds with billows (inside vdb/ only).
namespace lumulus::vdb {

/// Fills an empty volume with a cauliflower of spheres: bumps of ever smaller sizes stand on its surface, down to two
/// voxels. The flanks are eroded near the base, which is cut flat at the condensation level. The union of `puffs` is
/// scaled in height so that it is `height` metres high. Errors: Error where interrupted.
void fillBillowing(Volume& volume, std::vector<Puff> puffs, float height, std::uint64_t seed, const Report& report);

}  // namespace lumulus::vdb
