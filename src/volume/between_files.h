#pragma once

#include <cstddef>

#include "scene/scene.h"
#include "vdb/load.h"

/// Densities between two files of a sequence (inside volume/ only).
namespace lumulus {

/// The field of a cloud that lies between two files: both, each carried along the motion to that time, blended by how
/// near they are. Its voxels are those of the first one, or larger ones where the budget has no room for the box round
/// both. `index` of the cloud. Errors: those of vdb::load() and vdb::VelocityField::read().
vdb::LoadResult loadBetween(const scene::Cloud& cloud, std::size_t index, double memoryBudget,
                            const vdb::ReadLimits& limits);

}  // namespace lumulus
