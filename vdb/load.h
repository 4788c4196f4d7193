#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "vdb/volume.h"

namespace lumulus::vdb {

struct LoadOptions {
    std::string grid;                ///< name; empty: "density" if it exists, else the first float grid
    double memoryBudgetMiB = 512.0;  ///< for the dense volume at 2 bytes a voxel (R16F on the GPU)
    int maxExtent = 2048;            ///< voxels along a side, with the ring (a limit of 3D textures)
};

struct LoadResult {
    Volume volume;                      ///< placed by the grid's own transform
    Affine gridToWorld;                 ///< the grid's own transform: index coordinates → metres
    Affine voxelToGrid;                 ///< voxel coordinates of the volume → index coordinates
    double wantedMiB = 0.0;             ///< what the volume would take without a budget
    std::vector<std::string> warnings;  ///< warnings for a person, one line each
};

/// Reads a float (or half) grid of densities from an OpenVDB file into a dense volume.
/// The field is that of the box around the active voxels, inactive values and background in it included, cropped to its
/// nonzero part, with one ring of zeros around. A grid that is too large for the budget or the extent is averaged over
/// boxes of n³ voxels, with n as small as possible. This preserves its mass, and memory follows the size of the result,
/// not the full resolution. A grid without density gives a volume with `maximum` 0 and a warning. Throws InputError
/// for a file that cannot be read (missing, no OpenVDB, truncated, damaged), a grid that is not there, of another type
/// or a level set, a grid whose transform is not affine or is singular, and for values that are no densities (negative,
/// infinite, not a number; the one with the lexicographically smallest index coordinate is named). Throws Error where
/// interrupted.
LoadResult load(const std::filesystem::path& path, const LoadOptions& options);

}  // namespace lumulus::vdb
