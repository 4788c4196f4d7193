#pragma once

#include "scene/scene.h"
#include "vdb/volume.h"

namespace lumulus::cloud {

/// Into how many parts voxels with these edges (columns, metres) are divided along each axis, so that they are as fine
/// as light changes in a medium of this extinction [1/m]: 1 but along the long edges of flat ones. Odd, and no more
/// than leaves a volume of `size` voxels of a bounded size.
glm::ivec3 refinement(const glm::ivec3& size, const glm::dmat3& edges, double extinction);

/// How light is kept in clouds whose voxels are divided, where the scene does not say it: in more bands behind a
/// smaller forward cut, of more photons. Light that is scattered by a few degrees leaves a thin layer elsewhere than
/// light that is not (docs/experiments/flat-voxels.md).
scene::PhotonMap forFlatVoxels(const scene::PhotonMap& map);

/// The same field with each voxel divided into so many parts, which are odd numbers: a voxel's middle stays the middle
/// of one, so that the interpolated density is the same everywhere, and so are its maximum and the corner.
vdb::Volume refined(const vdb::Volume& volume, const glm::ivec3& parts);

/// Where the refined field lies for an instance of the coarse one.
inline vdb::Affine refined(const vdb::Affine& place, const glm::ivec3& parts) {
    return {glm::dmat3(place.linear[0] / static_cast<double>(parts.x), place.linear[1] / static_cast<double>(parts.y),
                       place.linear[2] / static_cast<double>(parts.z)),
            place.translation};
}

}  // namespace lumulus::cloud
