#include "light/photon/collector_light.h"

#include <algorithm>

#include "gpu/groups.h"
#include "gpu/transfer.h"
#include "shared/phase_table.h"
#include "shared/sun_axis.h"

namespace lumulus::photon {

namespace {

namespace spirv {
#include "spirv/photon/reconstruct.comp.h"
}  // namespace spirv

/// The media of all parts, each once, and which of them every collector has.
struct Media {
    std::vector<const phase::ScatteringTables*> tables;
    std::vector<std::uint32_t> ofCollectors;

    bool hasAxis() const {
        return std::ranges::any_of(tables, [](const auto* t) { return !t->axisTable.empty(); });
    }
    /// Moments of each medium by band, then the scale of its angles.
    std::vector<float> moments(int bands) const {
        std::vector<float> values;
        for (const auto* one : tables) {
            std::vector<float> own = one->bandMoments;
            own.resize(static_cast<std::size_t>(bands));
            own.push_back(one->angleScale);
            values.insert(values.end(), own.begin(), own.end());
        }
        return values;
    }
    std::vector<float> axisTables() const {
        std::vector<float> values;
        for (const auto* one : tables) {
            std::vector<float> own = one->axisTable;
            own.resize(static_cast<std::size_t>(shared::AXIS_RINGS * shared::singleScatterAngleCount));
            values.insert(values.end(), own.begin(), own.end());
        }
        return values;
    }
};

Media mediaOf(std::span<const MapPart> parts) {
    Media media;
    for (const MapPart& part : parts) {
        const phase::ScatteringTables& tables = part.medium.tables;
        const auto same = std::ranges::find_if(media.tables, [&](const phase::ScatteringTables* other) {
            return other->bandMoments == tables.bandMoments && other->axisTable == tables.axisTable &&
                   other->angleScale == tables.angleScale;
        });
        const auto number = static_cast<std::uint32_t>(same - media.tables.begin());
        if (same == media.tables.end()) media.tables.push_back(&tables);
        media.ofCollectors.insert(media.ofCollectors.end(), part.collectors, number);
    }
    return media;
}

/// A texel for each collector.
gpu::Image collectorImage(gpu::Context& context, const char* name, std::uint32_t collectors) {
    const glm::ivec2 extent(shared::COLLECTORS_WIDTH, collectors / shared::COLLECTORS_WIDTH + 1);
    return {context, name, extent, VK_FORMAT_R32G32B32A32_SFLOAT};
}

std::vector<gpu::SpecConstant> constantsFor(std::span<const MapPart> parts, int bands) {
    const Media media = mediaOf(parts);
    return {gpu::SpecConstant::of(0, bands), gpu::SpecConstant::of(1, media.hasAxis()),
            gpu::SpecConstant::of(2, media.tables.size() > 1)};
}

}  // namespace

CollectorLight::CollectorLight(gpu::Context& context, std::span<const MapPart> parts, int bands)
    : context_(context),
      collectors_(parts.back().firstCollector + parts.back().collectors),
      angleScale_(parts.front().medium.tables.angleScale),
      program_(context, "reconstruct", spirv::reconstruct_comp, constantsFor(parts, bands)),
      moments_(gpu::filledBuffer(context, "band moments", mediaOf(parts).moments(bands))),
      media_(context, "media of collectors", 0, gpu::Memory::device),
      axisTables_(context, "axis table", 4, gpu::Memory::device),
      places_(context, "collector places", collectors_ * sizeof(glm::vec4), gpu::Memory::device),
      fluences_(collectorImage(context, "collector fluences", collectors_)),
      colours_(collectorImage(context, "collector colours", collectors_)),
      radiance_(collectorImage(context, "collector radiance", collectors_)) {
    const Media media = mediaOf(parts);
    if (media.tables.size() > 1) media_ = gpu::filledBuffer(context, "media of collectors", media.ofCollectors);
    if (media.hasAxis()) axisTables_ = gpu::filledBuffer(context, "axis table", media.axisTables());
}

void CollectorLight::setPlaces(std::span<const glm::vec4> places) {
    gpu::upload(context_, places_, places);
}

void CollectorLight::record(gpu::Commands& commands, const gpu::Buffer& sum, shared::ReconstructPush push) const {
    push.collectors = collectors_;
    push.angleScale = angleScale_;
    commands.pass("reconstruct");
    commands.dispatch(program_,
                      {{"Sum", sum},
                       {"Moments", moments_},
                       {"Media", media_},
                       {"Collectors", places_},
                       {"fluences", fluences_},
                       {"radiance", radiance_},
                       {"colours", colours_},
                       {"AxisTable", axisTables_}},
                      push, gpu::linearGroups(collectors_, 64));
}

}  // namespace lumulus::photon
