#pragma once

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

#include "base/interrupt.h"
#include "base/progress.h"
#include "vdb/volume.h"

/// Shared parts of the procedural clouds (inside vdb/ only).
namespace lumulus::vdb {

Volume makeCumulus(int resolution, std::uint64_t seed, const Report& report);
Volume makeStratocumulus(int resolution, std::uint64_t seed, const Report& report);
Volume makeStratus(int resolution, std::uint64_t seed, const Report& report);
Volume makeCirrus(int resolution, std::uint64_t seed, const Report& report);
Volume makeSphere(int resolution, const Report& report);
Volume makeSlab(int resolution, const Report& report);

/// An empty volume whose voxels inside the ring just cover a box of `extent` metres that stands on y = 0 with its
/// middle above the origin. `flattening`: width of a voxel over its height.
Volume makeBox(const std::string& name, const glm::dvec3& extent, int resolution, double flattening = 1.0);

/// The middle of voxel (x, y, z) in metres.
inline glm::vec3 voxelCentre(const Volume& volume, int x, int y, int z) {
    return glm::vec3(volume.toWorld.point(glm::dvec3(x, y, z) + 0.5));
}

/// Calls `fill(z)` for each slice inside the ring, in parallel, and then finds the maximum. Errors: Error where
/// interrupted.
template <typename Fill>
void fillSlices(Volume& volume, const Report& report, const Fill& fill) {
    const auto slices = static_cast<std::uint64_t>(volume.size.z - 2);
    const std::thread::id caller = std::this_thread::get_id();
    std::atomic<std::uint64_t> done{0};
    report("making the cloud", 0, slices);
    tbb::parallel_for(1, volume.size.z - 1, [&](int z) {
        stopIfInterrupted();
        fill(z);
        const std::uint64_t now = ++done;
        if (std::this_thread::get_id() == caller) report("making the cloud", now, slices);
    });
    report("making the cloud", slices, slices);
    volume.maximum = *std::max_element(volume.density.begin(), volume.density.end());
}

/// Sets each voxel inside the ring to `density(x, y, z)`.
template <typename Density>
void fillVoxels(Volume& volume, const Report& report, const Density& density) {
    fillSlices(volume, report, [&](int z) {
        for (int y = 1; y < volume.size.y - 1; ++y) {
            for (int x = 1; x < volume.size.x - 1; ++x) {
                volume.density[volume.index(x, y, z)] = density(x, y, z);
            }
        }
    });
}

}  // namespace lumulus::vdb
