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

/// The part that this one was; null where it is new.
const MapPart* wasPart(const MapPlan& old, const MapPart& part, std::optional<std::size_t> before) {
    if (!before) return nullptr;
    const MapPart& was = old.parts[*before];
    const bool alike = was.asset == part.asset && was.collectors == part.collectors &&
                       was.estimates.edge == part.estimates.edge && was.estimates.cells == part.estimates.cells;
    return alike ? &was : nullptr;
}

}  // namespace

MapPart onlyPart(const cloud::Asset& cloud, const glm::dmat3& voxelToMetres, const Medium& medium,
                 const Options& options) {
    MapPart part;
    part.asset = &cloud;
    part.medium = medium;
    part.voxelToMetres = voxelToMetres;
    part.estimates = options.estimates;
    return part;
}

std::vector<BufferPart> keptCounts(const MapPlan& old, const MapPlan& plan,
                                   std::span<const std::optional<std::size_t>> before) {
    std::vector<BufferPart> kept;
    const auto keep = [&](std::uint64_t from, std::uint64_t to, std::uint64_t counts) {
        constexpr std::uint64_t bytes = sizeof(std::int64_t);
        kept.push_back({from * bytes, to * bytes, counts * bytes});
    };
    const auto each = static_cast<std::uint64_t>(3 * plan.bands * plan.bands);
    const bool axis = hasAxis(old.parts) && hasAxis(plan.parts);
    for (std::size_t i = 0; i < plan.parts.size(); ++i) {
        const MapPart& part = plan.parts[i];
        const MapPart* was = wasPart(old, part, before[i]);
        if (was == nullptr) continue;
        keep(was->firstCollector * each, part.firstCollector * each, part.collectors * each);
        if (part.estimates.edge > 0)
            keep(was->estimatorBase, part.estimatorBase, shared::estimatorCounts(part.estimates.cells));
        if (axis)
            keep(old.axisBase + was->firstCollector * shared::AXIS_COUNTS,
                 plan.axisBase + part.firstCollector * shared::AXIS_COUNTS,
                 std::uint64_t{part.collectors} * shared::AXIS_COUNTS);
    }
    return kept;
}

Extinctions keptExtinctions(const MapPlan& old, const Extinctions& ofOld, const MapPlan& plan,
                            std::span<const std::optional<std::size_t>> before) {
    Extinctions kept;
    for (const std::vector<double>& generation : ofOld) {
        std::vector<double>& now = kept.emplace_back();
        for (std::size_t i = 0; i < plan.parts.size(); ++i) {
            const MapPart* was = wasPart(old, plan.parts[i], before[i]);
            // of its own mass, which is what the light of a collector is divided by
            now.push_back(was == nullptr ? 0.0 : generation[*before[i]] * was->massScale() / plan.parts[i].massScale());
        }
    }
    return kept;
}

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
