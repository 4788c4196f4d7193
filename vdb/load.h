#pragma once

#include <array>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "vdb/read_limits.h"
#include "vdb/volume.h"

namespace lumulus::vdb {

struct LoadOptions {
    std::string grid;                ///< name in any case, `density[1]` for the second of that name; empty: see load
    double memoryBudgetMiB = 512.0;  ///< for the dense volume at 2 bytes a voxel (R16F on the GPU)
    int maxExtent = 2048;            ///< voxels along a side, with the ring (a limit of 3D textures)
    bool clamp = false;              ///< values that are no densities become 0, however large they are
    std::optional<std::array<glm::ivec3, 2>> part =
        {};                        ///< first and last index of what is taken; none: all of the grid
    std::string keys = "cloud.0";  ///< where the cloud's keys stand, for messages
    ReadLimits limits;             ///< of reading and resampling
};

struct LoadResult {
    Volume volume;                      ///< placed by the grid's own transform
    Affine gridToWorld;                 ///< the grid's own transform: index coordinates → metres
    Affine voxelToGrid;                 ///< voxel coordinates of the volume → index coordinates
    double wantedMiB = 0.0;             ///< what the volume would take without a budget
    std::vector<std::string> warnings;  ///< warnings for a person, one line each
};

/// Reads a grid of densities (float, half or double) from an OpenVDB or NanoVDB file into a dense volume.
///
/// Without a name the grid is chosen by the names of all: density, then smoke, cloud, extinction, lwc, qc and the like,
/// then names that say nothing; temperature, velocity and the like only where there is no other. A warning tells what
/// was taken unless it is called "density".
///
/// Only active voxels take part. The field is cropped to its nonzero part, with one ring of zeros around; what weighs
/// less than a millionth of the mass and lies apart is left out with a warning. Negatives down to −1 % of the maximum
/// become 0 with a warning. A grid that is too large for the budget or the extent is averaged over boxes of n³ voxels,
/// with n as small as possible, and at least so large that there are no more than 16³ of them for each leaf or tile
/// with density (2²⁰ are always allowed): few blocks far apart fill no memory. This preserves the mass, and memory
/// follows the size of the result, not the full resolution. A grid without density gives a volume with `maximum` 0 and
/// a warning.
///
/// Throws InputError for a file that cannot be read (missing, of another kind, truncated, damaged), a grid that is not
/// there, of another type or a level set, a grid whose transform is not affine or is singular, and, without `clamp`,
/// for values that are no densities: infinite, not a number, or lower than −1 % of the maximum; also for a grid whose
/// tree takes more than the limit, which is counted before it is made. Throws Error where interrupted, or what the
/// check throws. Only the grid that is taken is read, and empty ones before it, if the file tells where its grids lie.
LoadResult load(const std::filesystem::path& path, const LoadOptions& options);

}  // namespace lumulus::vdb
