#pragma once

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "vdb/volume.h"

/// What the makers of the procedural clouds share (inside vdb/ only).
namespace lumulus::vdb {

Volume makeCumulus(int resolution, std::uint64_t seed);
Volume makeStratus(int resolution, std::uint64_t seed);
Volume makeCirrus(int resolution, std::uint64_t seed);
Volume makeSphere(int resolution);
Volume makeSlab(int resolution);

/// An empty volume whose voxels inside the ring just cover a box of `extent` metres that stands on y = 0 with its
/// middle above the origin. `flattening`: width of a voxel over its height.
Volume makeBox(const std::string& name, const glm::dvec3& extent, int resolution, double flattening = 1.0);

/// Metres of the middle of voxel (x, y, z).
inline glm::vec3 voxelCentre(const Volume& volume, int x, int y, int z) {
    return glm::vec3(volume.toWorld.point(glm::dvec3(x, y, z) + 0.5));
}

/// Calls `fill(z)` for each slice inside the ring, in parallel, and then finds the maximum.
template <typename Fill>
void fillSlices(Volume& volume, const Fill& fill) {
    tbb::parallel_for(1, volume.size.z - 1, fill);
    volume.maximum = *std::max_element(volume.density.begin(), volume.density.end());
}

/// Sets each voxel inside the ring to `density(x, y, z)`.
template <typename Density>
void fillVoxels(Volume& volume, const Density& density) {
    fillSlices(volume, [&](int z) {
        for (int y = 1; y < volume.size.y - 1; ++y) {
            for (int x = 1; x < volume.size.x - 1; ++x) {
                volume.density[volume.index(x, y, z)] = density(x, y, z);
            }
        }
    });
}

}  // namespace lumulus::vdb
