#pragma once

#include <vector>

#include "render/world.h"
#include "vdb/placed_volume.h"

namespace lumulus {

/// Prepares the assets of a world whose instances have their places: those of the same field, medium and shape share
/// one, whatever their rotation, mirroring and size, and each level of detail has its own. Sets the instances' assets
/// and media, and their voxels where a level has larger ones. `placed` of each instance. Adds to the report's warnings.
/// Errors: InputError for a phase function that is none, Error where interrupted or out of memory.
void prepareAssets(gpu::Context& context, const scene::Scene& scene, const std::vector<vdb::PlacedVolume>& placed,
                   const WorldOptions& options, World& world, WorldReport& report);

/// Bounds of a cloud at another place, from those at one.
Bounds movedBounds(const Bounds& bounds, const vdb::Affine& from, const vdb::Affine& to);

}  // namespace lumulus
