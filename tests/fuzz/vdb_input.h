#pragma once

#include <cmath>

#include "fuzz/promise.h"
#include "vdb/describe.h"
#include "vdb/load.h"

namespace lumulus::test {

/// Reads bytes as an OpenVDB file, as a cloud of a scene and as `lumulus info` does. Throws std::logic_error where the
/// volume has values that are no densities, or is larger than it may be.
inline void feed(std::span<const std::byte> input) {
    vdb::LoadOptions options;
    options.memoryBudgetMiB = 0.25;
    readOrRefuse(input, "input.vdb", [&](const std::filesystem::path& path) {
        const vdb::Volume volume = vdb::load(path, options).volume;
        promise(volume.density.size() <= std::size_t{1} << 17U, "the budget is kept");
        for (const float value : volume.density)
            promise(value >= 0.0F && std::isfinite(value), "densities are finite and not negative");
    });
    readOrRefuse(input, "input.vdb", [](const std::filesystem::path& path) { vdb::describe(path); });
}

}  // namespace lumulus::test
