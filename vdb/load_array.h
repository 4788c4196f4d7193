#pragma once

#include <glm/glm.hpp>
#include <span>
#include <string>

#include "vdb/load.h"

namespace lumulus::vdb {

/// Densities in memory: value (i, j, k), z fastest, at the place `origin` + (i, j, k) · `edges` [m].
struct DensityArray {
    std::string name;  ///< in messages
    glm::ivec3 size{0};
    glm::dvec3 edges{1.0};
    glm::dvec3 origin{0.0};
    std::span<const float> values;
};

/// Makes a volume of an array as load() does of a grid with these values, all active but those that are 0. Errors:
/// those of load() for values and budget; InputError where the size is not that of the values, or a voxel has no size.
LoadResult loadArray(const DensityArray& array, const LoadOptions& options);

}  // namespace lumulus::vdb
