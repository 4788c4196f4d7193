#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "vdb/placed_volume.h"
#include "view/bounds.h"

namespace lumulus {

/// The voxels of a field that are not zero, as far as its bounds depend on them. Voxel coordinates.
struct FilledVoxels {
    glm::ivec3 low{0}, high{0};    ///< corners of their box; of that of all voxels where all are zero
    std::vector<glm::ivec3> ends;  ///< points whose convex hull holds them
};

/// Those of the cloud's field, which its place does not change.
FilledVoxels filledVoxels(const vdb::PlacedVolume& cloud);

/// boundsOf() a cloud whose field has these and lies there.
Bounds boundsOf(const FilledVoxels& filled, const vdb::Affine& toWorld);

}  // namespace lumulus
