#include "render/fog_change_view.h"

#include <algorithm>
#include <cmath>

#include "render/world_fog.h"
#include "render/world_media.h"
#include "shared/phase_table.h"

namespace lumulus {

namespace {

/// Photons that start for each photon of the map, and bounds of their number.
constexpr double startsForPhotons = 0.2;
constexpr double fewestStarts = 5e4, mostStarts = 1.6e6, coarseStarts = 2e4;

/// Scale of 1 − the mean cosine of peaks for the filter, whose variance is an eighth of that for each scattering event;
/// a third is seen on average, of light that peaks have scattered once and a half (an optical depth of 0.9).
constexpr double filterWidth = 4.4;

/// The media with the peaks of their scattering alone.
std::vector<scene::FogMedium> peaksOf(const std::vector<scene::FogMedium>& media,
                                      const std::vector<fog_light::FogLayer>& layers) {
    std::vector<scene::FogMedium> peaks = media;
    for (std::size_t i = 0; i < peaks.size(); ++i) {
        const fog_change::FogPaths path({layers[i]});
        const fog_change::CutPhase& phase = path.layers().front().phase;
        peaks[i].scattering *= phase.peak();
        peaks[i].absorption = peaks[i].emission = glm::dvec3(0.0);
        peaks[i].g = 1.0 - filterWidth * std::clamp(1.0 - phase.peakCosine(), 1e-5, 0.2);
    }
    return peaks;
}

scene::Fog fogOfPeaks(const World& world) {
    scene::Fog fog = world.fog;
    fog.media = peaksOf(world.fog.media, world.fogLight->layers());
    return fog;
}

/// The medium of the first cloud, as all are taken for.
fog_change::CloudMedium mediumOf(const World& world) {
    const phase::ScatteringMedium& medium = world.instances[world.visible().front()].medium;
    const auto straight = static_cast<double>(medium.tables.forwardFraction);
    fog_change::CloudMedium made;
    made.albedo = medium.albedo * (1.0 - straight) / (1.0 - straight * medium.albedo);
    if (medium.tables.analyticHg) {
        made.sampleCosine = [g = medium.tables.g, share = medium.tables.scatterFraction](double u) {
            return 1.0 - static_cast<double>(shared::sampleHg(g, static_cast<float>(u), share).oneMinusCos);
        };
        return made;
    }
    made.sampleCosine = [table = medium.tables.inverseCdf](double u) {
        const shared::TableCell cell = shared::inverseCdfCell(static_cast<float>(u));
        const auto at = static_cast<std::size_t>(cell.base);
        return 1.0 - static_cast<double>(glm::mix(table[at], table[at + 1], cell.fraction));
    };
    return made;
}

double startsFor(const World& world, bool coarse) {
    const double wanted = startsForPhotons * static_cast<double>(world.photonMap.photons);
    return coarse ? coarseStarts : std::clamp(wanted, fewestStarts, mostStarts);
}

}  // namespace

bool changesFog(const World& world) {
    return world.fogLight != nullptr && !world.visible().empty();
}

FogChangeView::FogChangeView(gpu::Context& context, const World& world, const Check& check)
    : peaks_(context, fogOfPeaks(world), check) {}

std::uint64_t FogChangeView::bytes() const {
    return (change_ ? change_->bytes() : 0) + (grid_ ? grid_->bytes() : 0) + seen_.light.size() * sizeof(glm::vec4);
}

void FogChangeView::update(gpu::Context& context, World& world, bool coarse, const Check& check) {
    Made now;
    glm::dvec3 first(0.0);
    for (const std::size_t i : world.visible()) {
        const cloud::Instance& instance = world.instances[i];
        const glm::dvec3 place = instance.origin + instance.offset;
        if (now.places.empty()) first = place;
        now.places.push_back(place - first);
        now.extinctions.push_back(instance.medium.extinction);
    }
    now.height = first.y;
    now.fogVersion = world.fogVersion;
    const bool sameClouds = change_ && now.hasCloudsOf(made_);
    drift_ = first - first_;
    if (sameClouds && now.fogVersion == made_.fogVersion && (coarse || !isCoarse_)) return;
    if (!sameClouds) {
        const query::Media media = straightMediaOf(context, world, check);
        const std::optional<double>& ground = world.fogLight->setting().groundHeight;
        grid_.emplace(media.clouds, ground, check);
        first_ = first;
        drift_ = glm::dvec3(0.0);
    }
    if (now.fogVersion != made_.fogVersion) peaks_.setMedia(peaksOf(world.fog.media, world.fogLight->layers()));
    const fog_light::FogSurroundings surroundings = fogSurroundings(world);
    const fog_change::CloudMedium medium = mediumOf(world);
    change_.emplace(
        fog_change::ChangeSources{surroundings, world.fogLight->setting().toSun, world.lights.direct().irradiance,
                                  *grid_, medium, static_cast<std::uint64_t>(startsFor(world, coarse)),
                                  world.photonMap.seed},
        check);
    made_ = std::move(now);
    isCoarse_ = coarse;
}

const fog_change::ChangeSeen& FogChangeView::seenBy(gpu::Context& context, World& world, const Camera& camera,
                                                    bool coarse, const Check& check) {
    update(context, world, coarse, check);
    Camera moved = camera;
    moved.position -= drift_;
    seen_ = change_->seenBy(moved, check);
    return seen_;
}

}  // namespace lumulus
