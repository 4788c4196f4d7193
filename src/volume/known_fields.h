#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "scene/scene.h"
#include "vdb/load.h"
#include "vdb/optical_thickness.h"
#include "view/filled_voxels.h"

namespace lumulus {

/// A field that was loaded, and what a scene has to know to show it. Of one in bricks, which are read again, that is
/// the volume alone: it tells that bricks are of the same source.
struct KnownField {
    scene::Cloud cloud;                         ///< that was the first to show it
    std::size_t index = 0;                      ///< of that cloud in its scene
    double budget = 0.0;                        ///< within which it was loaded [MiB]
    vdb::LoadResult loaded;                     ///< but for the volume
    std::shared_ptr<const vdb::Volume> volume;  ///< may be withoutValues()
    vdb::ColumnSums sums;
    FilledVoxels filled;
    bool inBricks = false;
};

/// The fields of a scene, for the next one: loadClouds() takes those that it shows again.
struct KnownFields {
    std::vector<KnownField> fields;
};

/// Those that a scene shows again.
KnownFields knownIn(const KnownFields& known, const scene::Scene& scene);

/// The field without its values: enough to place it, and to know what was made of it.
std::shared_ptr<const vdb::Volume> withoutValues(const vdb::Volume& volume);

/// Whether the values of a dense field are gone.
inline bool lacksValues(const vdb::Volume& volume) {
    return volume.density.empty() && !volume.empty();
}

}  // namespace lumulus
