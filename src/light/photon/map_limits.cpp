#include "light/photon/map_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"

namespace lumulus::photon {
namespace {

/// In MiB, rounded up: what does not fit never reads like what does.
std::string mebibytes(std::uint64_t bytes) {
    return fmt::format("{:.2f} MiB", std::ceil(100.0 * std::ldexp(static_cast<double>(bytes), -20)) / 100.0);
}

std::uint64_t parts(const MapSize& size) {
    return 2 + (size.splitGenerations ? 1U : 0U) + (size.keepRing ? static_cast<std::uint64_t>(size.generations) : 0);
}

}  // namespace

std::uint64_t generationBytes(const MapSize& size) {
    const std::uint64_t coefficients = size.collectors * 3 * static_cast<std::uint64_t>(size.bands * size.bands);
    return (coefficients + size.estimates) * sizeof(std::int64_t);
}

std::uint64_t mapBytes(const MapSize& size) {
    return parts(size) * generationBytes(size);
}

std::uint64_t mostCollectors(const MapSize& size, std::uint64_t budget, std::uint64_t largestBuffer) {
    MapSize one = size;
    one.collectors = 1;
    one.estimates = 0;
    return std::min(budget / parts(size), largestBuffer) / (2 * generationBytes(one));
}

void requireMapFits(const MapSize& size, std::uint64_t budget, std::uint64_t largestBuffer) {
    const std::uint64_t each = generationBytes(size);
    if (mapBytes(size) > budget) {
        const std::string held = size.keepRing ? fmt::format(", the sum of all and the ring of {}", size.generations)
                                               : std::string(" and the sum of all");
        throw InputError(
            fmt::format("the photon map needs {}, {} times {} for the newest generation{}{}; its budget is {}",
                        mebibytes(mapBytes(size)), parts(size), mebibytes(each),
                        size.splitGenerations ? " of each half" : "", held, mebibytes(budget)),
            "photon_map.memory_budget",
            fmt::format("raise it, or lower photon_map.bands, {}",
                        size.keepRing ? "preparation.max_leaves or photon_map.generations"
                                      : "preparation.samples or preparation.max_leaves"));
    }
    if (each > largestBuffer) {
        throw InputError(fmt::format("a generation of the photon map, {} collectors with {} bands, needs {}; the "
                                     "largest buffer of the device holds {}",
                                     size.collectors, size.bands, mebibytes(each), mebibytes(largestBuffer)),
                         "photon_map.bands", "lower it or preparation.max_leaves, or take another device");
    }
}

void requireCountable(std::uint64_t records) {
    // the power of a record has at most 21 bits and is multiplied by COEFFICIENT_SCALE = 2³ and a harmonic below 2
    if (records > (std::uint64_t{1} << 38U)) {
        throw Error(fmt::format("one generation left {} records, more than its sums can hold", records),
                    "photon_map.photons", "ask for more generations, or fewer photons");
    }
}

}  // namespace lumulus::photon
