#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "scene/scene.h"
#include "vdb/load.h"
#include "vdb/optical_thickness.h"

namespace lumulus {

/// A dense field that was loaded, and what a scene has to know to show it.
struct KnownField {
    scene::Cloud cloud;      ///< that was the first to show it
    std::size_t index = 0;   ///< of that cloud in its scene
    double budget = 0.0;     ///< within which it was loaded [MiB]
    vdb::LoadResult loaded;  ///< but for the volume
    std::shared_ptr<const vdb::Volume> volume;
    vdb::ColumnSums sums;
};

/// The dense fields of a scene, for the next one: loadClouds() takes those that it shows again.
struct KnownFields {
    std::vector<KnownField> fields;
};

}  // namespace lumulus
