#include "render/renderer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/stopwatch.h"
#include "render/renderer_state.h"
#include "volume/load.h"

namespace lumulus {

namespace {

constexpr double degrees = 3.14159265358979323846 / 180.0;

/// The scene, if all that is in it can be drawn.
const scene::Scene& drawable(const scene::Scene& scene) {
    if (!scene.surfaces.empty()) {
        throw InputError("surfaces are for the reference alone", scene.source + ", surface",
                         "use lumulus reference, or leave them out: --set surface=[]");
    }
    if (scene.clouds.size() > 1) {
        throw InputError("several clouds are for the reference alone", scene.source + ", cloud.1",
                         "use lumulus reference, or leave out all clouds but one");
    }
    return scene;
}

}  // namespace

void Renderer::State::makeMedium(const scene::Cloud& from, double maximum) {
    medium.extinction = from.extinction * from.densityScale * maximum;
    medium.albedo = from.albedo;
    medium.tables = phase::makeScatteringTables(from.phase, scene.photonMap.forwardCut * degrees, from.albedo,
                                                scene.photonMap.bands, scene.sun.angularDiameter * degrees);
}

void Renderer::State::prepareCloud(const vdb::Volume& volume) {
    cloud::PrepareOptions options;
    options.preparation = scene.preparation;
    options.majorant = scene.photonMap.majorant;
    const double forward = scene.photonMap.bands > 1 ? static_cast<double>(medium.tables.bandMoments[1]) : 0.0;
    options.reducedExtinction =
        medium.extinction * static_cast<double>(medium.tables.scatterFraction) * (1.0 - forward);
    cloud.emplace(cloud::prepare(context, volume, options));
    statistics.collectors = cloud->collectors.size();
    if (cloud->tree.limited)
        statistics.warnings.push_back("samples of the gradient asked for more than " +
                                      std::to_string(scene.preparation.maxLeaves) +
                                      " collectors: light is smeared in those that stay too large; raise "
                                      "preparation.max_leaves or lower preparation.samples");
}

void Renderer::State::preparePhotons() {
    if (!scatters() || !hasLight()) return;
    const scene::PhotonMap& wanted = scene.photonMap;
    const auto generations = static_cast<std::uint64_t>(wanted.generations);
    const std::uint64_t each = (static_cast<std::uint64_t>(wanted.photons) + generations - 1) / generations;
    if (each > 0xF0000000ULL)
        throw InputError("a generation would hold " + std::to_string(each) + " photons, more than 4026531840",
                         "photon_map.photons", "ask for more generations or fewer photons");
    // progressive: as fine as any number of photons may ask for
    estimatorGrid = light::lightGrid(
        *cloud, progressive ? std::numeric_limits<std::uint64_t>::max() : static_cast<std::uint64_t>(wanted.photons));
    photon::Options options;
    options.photonsPerGeneration = each;
    options.generations = wanted.generations;
    options.firstGeneration = static_cast<std::uint32_t>(wanted.firstGeneration);
    options.bands = wanted.bands;
    options.seed = wanted.seed;
    options.keepRing = keepRing;
    options.splitGenerations = progressive;
    options.estimates = estimatorGrid;
    options.check = check;
    options.memoryBudget = static_cast<std::uint64_t>(std::ldexp(wanted.memoryBudget, 20));
    photons.emplace(context, *cloud, medium, options);
}

Renderer::Renderer(const scene::Scene& scene, const RendererOptions& options)
    : state_(std::make_unique<State>(drawable(scene), options)) {
    State& s = *state_;
    s.statistics.device = s.context.device().name;
    if (!scene.fog.media.empty()) s.fog.emplace(s.context, scene.fog, s.check);
    if (scene.clouds.empty()) {
        makeCamera(scene.camera, scene.image, Bounds{});  // what is wrong with it shows before the work
        return;
    }
    const Stopwatch loading;
    CloudVolume loaded = loadCloudVolume(scene.clouds[0], scene.preparation.memoryBudget, s.report);
    s.statistics.warnings = std::move(loaded.warnings);
    s.statistics.loadSeconds = loading.seconds();
    s.bounds = boundsOf(loaded.volume);
    makeCamera(scene.camera, scene.image, s.bounds);
    s.dimSun();
    if (loaded.volume.empty()) return;

    const Stopwatch preparing;
    s.report("preparing the cloud", 0, 1);
    s.makeMedium(scene.clouds[0], static_cast<double>(loaded.volume.maximum));
    if (s.medium.extinction > 0.0) {
        s.prepareCloud(loaded.volume);
        stopIfInterrupted();
        s.preparePhotons();
        stopIfInterrupted();
        s.prepareDrawing();
    }
    s.report("preparing the cloud", 1, 1);
    s.statistics.prepareSeconds = preparing.seconds();
}

Renderer::~Renderer() = default;

int Renderer::generationsWanted() const {
    return state_->photons ? state_->scene.photonMap.generations : 0;
}

void Renderer::traceGeneration() {
    State& s = *state_;
    const Stopwatch watch;
    if (s.photons) s.photons->trace(s.sunlight, s.scene.sky);
    s.forgetLight();
    ++s.sinceChange;
    s.statistics.traceSeconds += watch.seconds();
}

void Renderer::State::prepareDrawing() {
    const draw::DrawFeatures features{!medium.tables.singleScatterH.empty(), scatters() && hasSun(),
                                      photons.has_value(), medium.albedo == glm::dvec3(medium.albedo.x)};
    if (features.sun) shadowVolume.emplace(context, *cloud);
    phase.emplace(context, medium.tables, features.grey);
    if (scene.draw.mode == scene::DrawMode::billboards) {
        billboards.emplace(context, *cloud, features);
    } else {
        march.emplace(context, *cloud, features);
    }
}

Statistics Renderer::statistics() const {
    Statistics result = state_->statistics;
    if (state_->photons) {
        const photon::Counters& c = state_->photons->counters();
        result.photons = c.emitted;
        result.generations = static_cast<std::uint64_t>(state_->photons->generationsInRing());
        result.events = c.events;
        result.nullCollisions = c.nulls;
        result.absorbed = c.absorbed;
        result.escaped = c.escaped;
        result.lost = c.lost;
        result.saturated = c.saturated;
        if (c.lost > 0)
            result.warnings.push_back(std::to_string(c.lost) + " of " + std::to_string(c.emitted) +
                                      " photons scattered too often and were given up: their light is missing");
        if (c.saturated > 0)
            result.warnings.push_back(std::to_string(c.saturated) +
                                      " coefficients met the limit of their integers: the picture is too dark there");
    }
    result.validationMessages = state_->context.validationMessages();
    return result;
}

}  // namespace lumulus
