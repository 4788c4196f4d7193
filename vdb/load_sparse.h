#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "vdb/load.h"
#include "vdb/sparse_volume.h"

namespace lumulus::vdb {

/// What the structure of a grid tells of it, before any value is read.
struct GridOutline {
    double denseMiB = 0.0;     ///< of a dense volume at 2 bytes a voxel, whatever its extent
    double filled = 0.0;       ///< share of the box that leaves and active tiles fill
    std::int64_t longest = 0;  ///< voxels along the longest side, with the ring
    double bricks = 0.0;       ///< of 8³ voxels in leaves and active tiles
    double roots = 0.0;        ///< of an index of bricks (SparseVolume)
};

/// Reads the structure of the grid that load() would take. Errors: those of load().
GridOutline outline(const std::filesystem::path& path, const LoadOptions& options);

struct SparseResult {
    SparseVolume volume;  ///< with leaves, but not laid out; placed by the grid's own transform
    Affine gridToWorld;   ///< the grid's own transform: index coordinates → metres
    Affine voxelToGrid;   ///< voxel coordinates of the volume → index coordinates
    std::vector<std::string> warnings;
};

/// Reads a grid of densities as leaves. Values are read leaf by leaf: once here, for what they are, and once more when
/// `volume.leaves.read` asks for them, for which the file must stay. In memory at a time are the structure of the tree
/// and the values of some thousands of leaves. NanoVDB files, grids of doubles and OpenVDB files of several grids that
/// do not tell where these lie are kept as trees instead. The box is that of load(), on whole leaves; what load() says
/// of values, warnings and errors holds here too, but for averaging. Errors: also InputError where there are more than
/// 2²³ bricks in tiles.
SparseResult loadSparse(const std::filesystem::path& path, const LoadOptions& options);

}  // namespace lumulus::vdb
