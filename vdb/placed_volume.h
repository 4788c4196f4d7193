#pragma once

#include "vdb/volume.h"

namespace lumulus::vdb {

struct SparseVolume;

/// A density field where one cloud has it: clouds of the same file share the field and differ by their place. Keeps
/// pointers to the volumes.
struct PlacedVolume {
    /// The volume at its own place.
    PlacedVolume(const Volume& field) : volume(&field), toWorld(field.toWorld) {}
    PlacedVolume(const Volume& field, const Affine& place) : volume(&field), toWorld(place) {}

    const Volume* volume;                  ///< never null
    const SparseVolume* bricks = nullptr;  ///< the field, where it is in bricks: `volume` has no values then
    Affine toWorld;                        ///< voxel coordinates → metres
};

}  // namespace lumulus::vdb
