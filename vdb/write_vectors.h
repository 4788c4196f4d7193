#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "base/interrupt.h"

namespace lumulus::vdb {

/// A grid of vectors: a direction of the world, or three colours.
struct VectorGrid {
    std::string name, unit, meaning;  ///< the last two as metadata
    bool isDirection = false;
    std::vector<glm::vec3> values;  ///< of each place
};

/// Grids on the same voxels, along the axes of the world.
struct VectorGrids {
    double voxel = 1.0;  ///< edge [m]; the middle of voxel (i, j, k) is (i, j, k) times the edge
    std::vector<glm::ivec3> places;
    std::vector<VectorGrid> grids;
};

enum class VectorFormat { openVdb, nanoVdb };

/// Writes them as a whole file, OpenVDB or NanoVDB (which keeps names and no metadata). Equal grids give equal bytes.
/// Errors: those of writeFile; Error for what the library refuses; what `check` throws.
void writeVectors(const std::filesystem::path& path, const VectorGrids& grids, VectorFormat format, const Check& check);

}  // namespace lumulus::vdb
