#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "vdb/optical_thickness.h"
#include "vdb/volume.h"

namespace lumulus::vdb {

/// Statistics of the active values of a float or double grid. Those that are not finite have no part in them.
struct ValueStatistics {
    double minimum = 0.0;
    double maximum = 0.0;
    double mean = 0.0;
    double background = 0.0;
    std::uint64_t notFinite = 0;  ///< active voxels that are infinite or not a number
};

/// Where a grid lies.
struct Place {
    Affine toWorld;           ///< index coordinates → metres
    glm::dvec3 minimum{0.0};  ///< metres: corner of the box around the cubes of all active voxels …
    glm::dvec3 maximum{0.0};  ///< … and the opposite one; equal to the minimum where no voxel is active
    bool mirrored = false;    ///< left and right are swapped
    bool rotated = false;     ///< an axis of the grid does not lie along the same axis of the world
};

struct GridInfo {
    std::string name;
    std::string type;       ///< of the values: "float", "half" (floats saved as half), "double", "vec3s", "int32", …
    std::string gridClass;  ///< "fog volume", "level set", "staggered" or "unknown"
    bool levelSet = false;
    bool affine = false;                    ///< true if its transform is affine (a frustum is not)
    glm::ivec3 activeMinimum{0};            ///< index coordinates of the box around the active voxels …
    glm::ivec3 activeMaximum{-1};           ///< … both ends included; below the minimum where no voxel is active
    std::uint64_t activeVoxels = 0;         ///< tiles counted as the voxels that they stand for
    glm::dvec3 voxelSize{0.0};              ///< metres along the index axes
    std::optional<Place> place;             ///< absent if the transform is not affine
    std::optional<ValueStatistics> values;  ///< absent if the grid holds no scalars or none is active
    /// At extinction 1/m where the value is 1, as a rendered cloud has it within the default memory budget. Absent
    /// where `load` refuses the grid or finds nothing in it.
    std::optional<OpticalThickness> thickness;
    /// Bricks of 8³ voxels in leaves and active tiles, and those of the whole box; absent where the grid holds no
    /// scalars or none is active.
    std::optional<std::pair<std::uint64_t, double>> bricks;
    bool taken = false;  ///< whether a scene that names no grid shows this one
};

/// Describes the grids of an OpenVDB or NanoVDB file, in the order of the file.
/// Throws InputError for a file that cannot be read, as `load` does, Error if interrupted.
std::vector<GridInfo> describe(const std::filesystem::path& path);

}  // namespace lumulus::vdb
