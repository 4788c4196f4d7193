#include "light/photon/map_layout.h"

#include <algorithm>

#include "light/photon/ground.h"
#include "light/photon/map_limits.h"
#include "shared/collision_estimator.h"
#include "shared/sun_axis.h"

namespace lumulus::photon {

namespace {

bool hasAxis(std::span<const MapPart> parts) {
    return std::ranges::any_of(parts, [](const MapPart& part) { return !part.medium.tables.axisTable.empty(); });
}

}  // namespace

std::uint32_t layOut(std::vector<MapPart>& parts, int bands) {
    std::uint64_t collectors = 0;
    for (MapPart& part : parts) {
        part.firstCollector = static_cast<std::uint32_t>(collectors);
        part.collectors = part.collects ? static_cast<std::uint32_t>(part.asset->collectors.size()) : 0;
        collectors += part.collectors;
    }
    std::uint64_t next = collectors * 3 * static_cast<std::uint64_t>(bands * bands);
    for (MapPart& part : parts) {
        if (!part.collects) part.estimates = {};
        part.estimatorBase = static_cast<std::uint32_t>(next);
        if (part.estimates.edge > 0) next += shared::estimatorCounts(part.estimates.cells);
    }
    return static_cast<std::uint32_t>(next);
}

std::uint32_t collectorsOf(std::span<const MapPart> parts) {
    return parts.back().firstCollector + parts.back().collectors;
}

std::uint32_t groundBase(std::span<const MapPart> parts, std::uint32_t axisBase) {
    return axisBase + (hasAxis(parts) ? collectorsOf(parts) * shared::AXIS_COUNTS : 0U);
}

std::uint32_t coefficientsOf(const gpu::Context& context, std::span<const MapPart> parts, const Options& options) {
    const std::uint64_t collectors = collectorsOf(parts);
    std::uint64_t estimates = hasAxis(parts) ? collectors * shared::AXIS_COUNTS : 0;
    for (const MapPart& part : parts)
        if (part.estimates.edge > 0) estimates += shared::estimatorCounts(part.estimates.cells);
    if (options.ground) estimates += groundCounts();
    const MapSize size{collectors, options.bands, options.generations, options.keepRing, options.splitGenerations,
                       estimates};
    requireMapFits(size, options.memoryBudget, context.limits().maxStorageBufferRange);
    return static_cast<std::uint32_t>(generationBytes(size) / sizeof(std::int64_t));
}

}  // namespace lumulus::photon
