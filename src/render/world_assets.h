#pragma once

#include <memory>
#include <vector>

#include "render/world.h"
#include "vdb/placed_volume.h"

namespace lumulus {

/// Prepares the assets of a world whose instances have their places: those of the same field, medium and shape share
/// one, whatever their rotation, mirroring and size, and each level of detail has its own. `pool` has the texels of
/// fields in bricks, null where they are dense. Sets the instances' assets
/// and media, and their voxels where a level has larger ones. What is kept of the world before is taken where it is the
/// same, and the rest of it dropped before any is made. Adds to the report's assets and warnings. Errors: InputError
/// for a phase function that is none, Error where interrupted or out of memory.
void prepareAssets(gpu::Context& context, const scene::Scene& scene, const CloudVolumes& volumes,
                   const std::shared_ptr<const gpu::Image>& pool, const WorldOptions& options, World& world,
                   WorldReport& report);

/// Texels of all fields that are in bricks; null where there are none.
std::shared_ptr<const gpu::Image> makePool(gpu::Context& context, std::vector<vdb::SparseVolume>& bricks,
                                           const Check& check);

/// Gives an instance albedo and phase function of a cloud of the scene. Its extinction stays. Errors: InputError for a
/// phase function that is none.
void setSubstance(cloud::Instance& instance, const scene::PhotonMap& map, const scene::Cloud& cloud,
                  const scene::Sun& sun);

/// Bounds of a cloud at another place, from those at one.
Bounds movedBounds(const Bounds& bounds, const vdb::Affine& from, const vdb::Affine& to);

}  // namespace lumulus
