#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

namespace lumulus::vdb {

/// Statistics of the active values of a float or double grid.
struct ValueStatistics {
    double minimum = 0.0;
    double maximum = 0.0;
    double mean = 0.0;
    double background = 0.0;
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
    std::optional<ValueStatistics> values;  ///< absent if the grid holds no scalars or none is active
};

/// Describes the grids of an OpenVDB file, in the order of the file.
/// Throws InputError for a file that cannot be read, as `load` does, Error if interrupted.
std::vector<GridInfo> describe(const std::filesystem::path& path);

}  // namespace lumulus::vdb
