#pragma once

#include "vdb/volume.h"

namespace lumulus::vdb {

/// A density field where one cloud has it: clouds of the same file share the field and differ by their place. Keeps a
/// pointer to the volume.
struct PlacedVolume {
    /// The volume at its own place.
    PlacedVolume(const Volume& field) : volume(&field), toWorld(field.toWorld) {}
    PlacedVolume(const Volume& field, const Affine& place) : volume(&field), toWorld(place) {}

    const Volume* volume;  ///< never null
    Affine toWorld;        ///< voxel coordinates → metres
};

}  // namespace lumulus::vdb
