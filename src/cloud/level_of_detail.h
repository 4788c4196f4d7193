#pragma once

#include "vdb/placed_volume.h"
#include "vdb/volume.h"

namespace lumulus::cloud {

/// The coarsest level of detail: voxels 2⁶ times as large.
inline constexpr int coarsestLevel = 6;

/// Level of detail of a cloud of so many voxels along its longest side, whose voxels are `voxelPixels` pixels large at
/// its nearest point: voxels are twice as large on each level, and no larger than a pixel; 0 is the field itself.
int levelOfDetail(int longestSide, double voxelPixels);

/// The coarsest level whose voxels light still crosses, where those of the field have this optical thickness at most:
/// coarser ones have no rough surface that shades itself, and are too bright.
int levelOfThickness(double voxelThickness);

/// Collectors of a cloud that is `pixels` large in the picture: 30 + 0.4 pixels².
int collectorsFor(double pixels);

/// The field with voxels 2^level times as large, each the mean of those in it, with the same mass and corner. `maximum`
/// is that of the means.
vdb::Volume coarsened(const vdb::Volume& volume, int level);

/// Where the coarse field lies for an instance of the fine one.
inline vdb::Affine coarsened(const vdb::Affine& place, int level) {
    return {place.linear * static_cast<double>(1 << level), place.translation};
}

}  // namespace lumulus::cloud
