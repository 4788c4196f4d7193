#pragma once

#include <glm/glm.hpp>

#include "base/interrupt.h"
#include "vdb/volume.h"

namespace lumulus::vdb {

/// Sums of a volume's density over its columns of voxels along x, y and z. Columns without density do not count.
struct ColumnSums {
    glm::dvec3 largest{0.0};
    glm::dvec3 mean{0.0};  ///< over the columns that meet the cloud
};

/// Errors: what `check` throws, which is asked on any thread.
ColumnSums columnSums(const Volume& volume, const Check& check = stopIfInterrupted);

struct SparseVolume;

/// The same of a field in leaves, with columns of 8² voxels.
ColumnSums columnSums(const SparseVolume& volume);

/// Optical thickness of a cloud along the three axes of its grid, from edge to edge.
struct OpticalThickness {
    glm::dvec3 largest{0.0};  ///< along x, y and z of the grid
    glm::dvec3 mean{0.0};     ///< over the columns of voxels that meet the cloud

    double largestOfAll() const { return glm::max(largest.x, glm::max(largest.y, largest.z)); }
    double meanOfAll() const { return (mean.x + mean.y + mean.z) / 3.0; }
};

/// Optical thickness of a field at a place. `extinction` in 1/m where the density is 1.
inline OpticalThickness opticalThickness(const ColumnSums& sums, const Affine& toWorld, double extinction) {
    const glm::dvec3 edges(glm::length(toWorld.linear[0]), glm::length(toWorld.linear[1]),
                           glm::length(toWorld.linear[2]));
    return {extinction * edges * sums.largest, extinction * edges * sums.mean};
}

}  // namespace lumulus::vdb
