#pragma once

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <glm/glm.hpp>
#include <thread>

#include "base/interrupt.h"
#include "base/progress.h"
#include "vdb/volume.h"

/// Volumes that are filled block by block, in parallel (inside vdb/ only).
namespace lumulus::vdb {

/// Voxels from `first` to before `end`.
struct Block {
    glm::ivec3 first{0};
    glm::ivec3 end{0};
};

/// Number of blocks of `edge` voxels along each axis that hold the voxels of `block`.
inline glm::ivec3 blocksAlong(const Block& block, int edge) {
    return (block.end - block.first + edge - 1) / edge;
}

/// Block `number` (x fastest) of those of `edge` voxels in `whole`; the last ones may be smaller.
inline Block blockAt(const Block& whole, int edge, int number) {
    const glm::ivec3 count = blocksAlong(whole, edge);
    const glm::ivec3 place(number % count.x, number / count.x % count.y, number / (count.x * count.y));
    const glm::ivec3 first = whole.first + place * edge;
    return {first, glm::min(first + edge, whole.end)};
}

/// Calls `fill(block)` for blocks of `edge` voxels that together are all voxels inside the ring, in parallel, and then
/// finds the maximum. What a voxel becomes must not depend on other blocks. Errors: Error where interrupted.
template <typename Fill>
void fillBlocks(Volume& volume, int edge, const Report& report, const Fill& fill) {
    const Block whole{glm::ivec3(1), volume.size - 1};
    const glm::ivec3 along = blocksAlong(whole, edge);
    const int count = along.x * along.y * along.z;
    const std::thread::id caller = std::this_thread::get_id();
    std::atomic<std::uint64_t> done{0};
    report("making the cloud", 0, static_cast<std::uint64_t>(count));
    tbb::parallel_for(0, count, [&](int number) {
        stopIfInterrupted();
        fill(blockAt(whole, edge, number));
        const std::uint64_t now = ++done;
        if (std::this_thread::get_id() == caller) report("making the cloud", now, static_cast<std::uint64_t>(count));
    });
    report("making the cloud", static_cast<std::uint64_t>(count), static_cast<std::uint64_t>(count));
    volume.maximum = *std::max_element(volume.density.begin(), volume.density.end());
}

}  // namespace lumulus::vdb
