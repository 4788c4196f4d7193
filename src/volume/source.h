#pragma once

#include <cstddef>
#include <string>

#include "scene/scene.h"
#include "vdb/load.h"
#include "vdb/sparse_volume.h"
#include "vdb/transform.h"

/// Sources of density fields (inside volume/ only).
namespace lumulus {

/// A field as its source gives it, and how far its memory can be told.
struct Source {
    const scene::Cloud* cloud;  ///< the first one of this source
    std::size_t index;          ///< of that cloud in the scene
    vdb::LoadResult loaded;
    vdb::SparseVolume bricks;  ///< of a file whose field is in bricks; `loaded` has no values then

    bool isFile() const { return !cloud->vdb.empty(); }
    /// Metres from voxel coordinates under a transform of the scene.
    vdb::Affine placeUnder(const glm::dmat4& transform, const std::string& where) const {
        return vdb::composed(vdb::composeTransforms(transform, loaded.gridToWorld, where), loaded.voxelToGrid);
    }
};

}  // namespace lumulus
