#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <tuple>

#include "scene/scene.h"
#include "vdb/load.h"
#include "vdb/optical_thickness.h"
#include "vdb/sparse_volume.h"
#include "vdb/transform.h"
#include "view/filled_voxels.h"

/// Sources of density fields (inside volume/ only).
namespace lumulus {

/// What a field depends on: clouds that agree in it share the field.
inline auto sourceOf(const scene::Cloud& cloud) {
    const bool made = cloud.vdb.empty() && !cloud.voxels;  // procedural
    const bool file = !cloud.vdb.empty() && !cloud.voxels;
    const bool between = file && cloud.moment && !cloud.moment->next.empty();
    return std::tuple(cloud.voxels, file ? cloud.vdb : std::filesystem::path(), file ? cloud.grid : std::string(),
                      made ? cloud.procedural : std::string(), made ? cloud.resolution : 0, made ? cloud.seed : 0,
                      !made && cloud.clamp, file ? cloud.part : std::nullopt, between ? cloud.moment->file : 0.0,
                      between ? cloud.velocity : std::optional<scene::Wind>());
}

/// A field as its source gives it, and how far its memory can be told.
struct Source {
    const scene::Cloud* cloud;                  ///< the first one of this source
    std::size_t index;                          ///< of that cloud in the scene
    vdb::LoadResult loaded;                     ///< but for the volume
    std::shared_ptr<const vdb::Volume> volume;  ///< of a field in bricks without values
    std::optional<vdb::ColumnSums> sums;        ///< where they are known
    std::optional<FilledVoxels> filled;         ///< where they are known
    double budget = 0.0;                        ///< within which it was loaded [MiB]
    vdb::SparseVolume bricks;                   ///< of a file whose field is in bricks

    /// Between two files of a sequence: made of both, in voxels.
    bool isBetween() const { return cloud->moment && !cloud->moment->next.empty(); }
    /// Whether the field lies in a file as it is.
    bool isFile() const { return !cloud->vdb.empty() && !cloud->voxels && !isBetween(); }
    /// Metres from voxel coordinates under a transform of the scene.
    vdb::Affine placeUnder(const glm::dmat4& transform, const std::string& where) const {
        return vdb::composed(vdb::composeTransforms(transform, loaded.gridToWorld, where), loaded.voxelToGrid);
    }
};

}  // namespace lumulus
