#include "renderer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>

#include "base/error.h"
#include "base/interrupt.h"
#include "cloud/cloud.h"
#include "draw/bands.h"
#include "draw/billboards.h"
#include "draw/camera.h"
#include "draw/collector_sun.h"
#include "draw/light_field.h"
#include "draw/march.h"
#include "draw/sky.h"
#include "draw/sun_depth.h"
#include "draw/view.h"
#include "fog/frame.h"
#include "fog/media.h"
#include "gpu/commands.h"
#include "photon/photon_map.h"
#include "volume/load.h"

namespace lumulus {

namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

constexpr double degrees = 3.14159265358979323846 / 180.0;

double largest(const glm::dvec3& v) {
    return std::max(v.x, std::max(v.y, v.z));
}

/// The scene, if all that is in it can be drawn.
const scene::Scene& drawable(const scene::Scene& scene) {
    if (!scene.surfaces.empty()) {
        throw InputError("surfaces are for the reference alone", scene.source + ", surface",
                         "use lumulus reference, or leave them out: --set surface=[]");
    }
    return scene;
}

void addTime(std::vector<PassTime>& times, const gpu::PassTime& pass) {
    const auto known = std::find_if(times.begin(), times.end(), [&](const PassTime& t) { return t.name == pass.name; });
    if (known == times.end())
        times.push_back({pass.name, pass.milliseconds});
    else
        known->milliseconds += pass.milliseconds;
}

}  // namespace

struct Renderer::State {
    State(const scene::Scene& theScene, const RendererOptions& options)
        : scene(theScene),
          report(options.report),
          progressive(options.progressive),
          context({options.device, options.validation}),
          commands(context) {}

    scene::Scene scene;
    Report report;
    bool progressive;
    gpu::Context context;
    gpu::Commands commands;
    Camera camera;

    // What follows exists only where the scene needs it.
    photon::Medium medium;
    std::optional<cloud::Cloud> cloud;
    cloud::CellGrid depositGrid;
    std::optional<photon::PhotonMap> photons;
    std::optional<draw::SunDepth> sunDepth;
    std::optional<draw::CollectorSun> collectorSun;
    std::optional<draw::PhaseTables> phase;
    std::optional<draw::LightField> lightField;
    std::optional<draw::Billboards> billboards;
    std::optional<draw::March> march;
    std::optional<fog::Fog> fog;
    scene::Sun sunlight = scene.sun;  ///< that reaches the cloud through the fog

    bool sunDrawn = false;  // the sun's depths are up to date
    Statistics statistics;

    bool scatters() const { return largest(medium.albedo) > 0.0; }
    bool hasSun() const { return largest(sunlight.irradiance) > 0.0; }
    bool hasLight() const { return hasSun() || largest(scene.sky.radiance) > 0.0; }

    void makeMedium(const scene::Cloud& from, double maximum);
    void prepareCloud(const vdb::Volume& volume);
    void preparePhotons();
    void drawCloud(LayeredImage& image);
    void prepareDrawing();
    shared::FieldParams fieldParams() const;
    void makeLightField(std::uint64_t forPhotons);
    void recordLight(photon::Part part);
    void applyFog(LayeredImage& image);
    void drawLight(photon::Part part);
    void drawBands(LayeredImage& image, const std::vector<draw::Band>& bands, const Report& told);
    void drawBand(LayeredImage& image, const draw::FrameInputs& inputs, gpu::Buffer& params, const draw::Band& band);
    double passSeconds() const;
    glm::dvec3 toVoxel(const glm::dvec3& world) const;
    glm::vec3 eyeVoxel() const;
};

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
    options.reducedExtinction = medium.extinction * static_cast<double>(medium.tables.turnFraction) * (1.0 - forward);
    cloud.emplace(cloud::prepare(context, volume, options));
    statistics.collectors = cloud->collectors.size();
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
    depositGrid = draw::lightGrid(
        *cloud, progressive ? std::numeric_limits<std::uint64_t>::max() : static_cast<std::uint64_t>(wanted.photons));
    photon::Options options;
    options.photonsPerGeneration = each;
    options.generations = wanted.generations;
    options.firstGeneration = static_cast<std::uint32_t>(wanted.firstGeneration);
    options.bands = wanted.bands;
    options.seed = wanted.seed;
    options.deposits = depositGrid;
    options.memoryBudget = static_cast<std::uint64_t>(std::ldexp(wanted.memoryBudget, 20));
    options.keepHalves = progressive;
    photons.emplace(context, *cloud, medium, options);
}

Renderer::Renderer(const scene::Scene& scene, const RendererOptions& options)
    : state_(std::make_unique<State>(drawable(scene), options)) {
    State& s = *state_;
    s.statistics.device = s.context.device().name;
    if (!scene.fog.media.empty()) s.fog.emplace(s.context, scene.fog);
    if (scene.clouds.empty()) {
        s.camera = makeCamera(scene.camera, scene.image, Bounds{});
        return;
    }
    auto start = Clock::now();
    CloudVolume loaded = loadCloudVolume(scene.clouds[0], scene.preparation.memoryBudget, s.report);
    s.statistics.warnings = std::move(loaded.warnings);
    s.statistics.loadSeconds = secondsSince(start);
    const Bounds bounds = boundsOf(loaded.volume);
    s.camera = makeCamera(scene.camera, scene.image, bounds);
    if (s.fog) s.sunlight.irradiance *= fog::sunTransmittance(scene.fog, bounds.centre, scene.sun.directionTo);
    if (loaded.volume.empty()) return;

    start = Clock::now();
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
    s.statistics.prepareSeconds = secondsSince(start);
}

Renderer::~Renderer() = default;

int Renderer::generationsWanted() const {
    return state_->photons ? state_->scene.photonMap.generations : 0;
}

void Renderer::traceGeneration() {
    State& s = *state_;
    const auto start = Clock::now();
    if (s.photons) s.photons->trace(s.sunlight, s.scene.sky);
    s.statistics.traceSeconds += secondsSince(start);
}

void Renderer::State::prepareDrawing() {
    const draw::DrawFeatures features{!medium.tables.oneTurnH.empty(), scatters() && hasSun(), photons.has_value(),
                                      medium.albedo == glm::dvec3(medium.albedo.x)};
    if (features.sun) sunDepth.emplace(context, *cloud);
    if (features.photons) makeLightField(static_cast<std::uint64_t>(scene.photonMap.photons));
    phase.emplace(context, medium.tables);
    if (scene.draw.mode == scene::DrawMode::billboards) {
        billboards.emplace(context, *cloud, features);
        if (features.sun) collectorSun.emplace(context, *cloud);
    } else {
        march.emplace(context, *cloud, features);
    }
}

void Renderer::State::makeLightField(std::uint64_t forPhotons) {
    const cloud::CellGrid grid = draw::lightGrid(*cloud, forPhotons);
    if (!lightField || !(grid == lightField->grid())) lightField.emplace(context, *cloud, grid, depositGrid);
}

glm::dvec3 Renderer::State::toVoxel(const glm::dvec3& world) const {
    return glm::inverse(cloud->toWorld.linear) * (world - cloud->toWorld.translation);
}

glm::vec3 Renderer::State::eyeVoxel() const {
    // An orthographic eye is far away: all collectors see it in one direction.
    glm::dvec3 eye = camera.position;
    if (camera.projection == scene::Projection::orthographic)
        eye -= camera.axes[2] * (1e5 * glm::length(cloud->toWorld.linear * glm::dvec3(cloud->size)));
    return glm::vec3(toVoxel(eye));
}

shared::FieldParams Renderer::State::fieldParams() const {
    shared::FieldParams field{};
    field.worldToVoxel = glm::mat3(glm::inverse(cloud->toWorld.linear));
    field.eyeVoxel = glm::vec3(toVoxel(camera.position));
    field.size = glm::vec3(cloud->size);
    field.cells = cloud->cells.cells;
    field.cellSize = cloud->cells.cellSize;
    field.extinction = static_cast<float>(medium.extinction);
    field.voxelLength = static_cast<float>(std::cbrt(cloud->voxelVolume));
    if (lightField) field.radianceScale = lightField->scale();
    if (sunDepth) {
        field.voxelToSun = sunDepth->voxelToTexture();
        field.sunOffset = sunDepth->textureOffset();
    }
    return field;
}

/// Light in the cloud as this view sees it; the sun's depths only once.
void Renderer::State::recordLight(photon::Part part) {
    if (sunDepth && !sunDrawn) {
        sunDepth->record(commands, -sunlight.directionTo, medium.extinction);
        if (collectorSun) {
            commands.barrier("sun depths");
            collectorSun->record(commands, *sunDepth);
        }
        sunDrawn = true;
    }
    if (photons) {
        const photon::Light light = photons->light(part);
        photons->reconstruct(commands, eyeVoxel(), light);
        commands.barrier("collector radiance");
        lightField->record(
            commands, photons->radiance(),
            {*light.counts, photons->depositBase(), light.unit, photons->photonPower(), photons->massScale()});
    }
}

void Renderer::State::drawBand(LayeredImage& image, const draw::FrameInputs& inputs, gpu::Buffer& params,
                               const draw::Band& band) {
    shared::DrawParams values{};
    values.view = draw::viewParams(camera);
    values.light = draw::lightParams(sunlight, scene.sky, medium.albedo, medium.tables);
    values.light.sunDisc = draw::lightParams(scene.sun, scene.sky, medium.albedo, medium.tables).sunDisc;
    values.field = fieldParams();
    values.firstRow = band.first;
    values.rows = band.rows;
    values.samples =
        draw::raysAcross(camera, cloud->toWorld.point(0.5 * glm::dvec3(cloud->size)), std::cbrt(cloud->voxelVolume));
    values.tilesAcross = billboards ? billboards->tilesAcross() : 0;
    params.mapped<shared::DrawParams>()[0] = values;
    commands.begin();
    if (billboards)
        billboards->record(commands, inputs, values);
    else
        march->record(commands, inputs, values);
    commands.submit();
    commands.wait();
    for (const gpu::PassTime& pass : commands.times()) addTime(statistics.passes, pass);
    draw::copyPixels(inputs.pixels.mapped<const shared::Pixel>(), image, band.first, band.rows);
}

/// The light that this view sees, by all photons or by a part of them.
void Renderer::State::drawLight(photon::Part part) {
    if (photons && progressive) makeLightField(photons->counters().emitted);
    if (sunDepth || photons) {
        commands.begin();
        recordLight(part);
        commands.submit();
        commands.wait();
        for (const gpu::PassTime& pass : commands.times()) addTime(statistics.passes, pass);
    }
    if (billboards)
        billboards->prepare(camera, medium.extinction,
                            collectorSun ? collectorSun->values() : std::span<const float>());
}

void Renderer::State::drawBands(LayeredImage& image, const std::vector<draw::Band>& bands, const Report& told) {
    gpu::Buffer params(context, "draw params", sizeof(shared::DrawParams), gpu::Memory::host);
    const gpu::Buffer pixels(context, "pixels",
                             static_cast<std::uint64_t>(draw::bandRows(camera)) *
                                 static_cast<std::uint64_t>(camera.width) * sizeof(shared::Pixel),
                             gpu::Memory::host);
    // Stands for fields that the scene does not have: the shaders never read it, but every binding must be there.
    const gpu::Image none(context, "none", glm::ivec3(1), VK_FORMAT_R32G32B32A32_SFLOAT);
    const draw::FrameInputs inputs{params, *phase, lightField ? lightField->image() : none,
                                   sunDepth ? sunDepth->image() : none, pixels};
    told("drawing", 0, bands.size());
    for (std::size_t done = 0; done < bands.size(); ++done) {
        stopIfInterrupted();
        drawBand(image, inputs, params, bands[done]);
        told("drawing", done + 1, bands.size());
    }
    statistics.gpuBytes = context.allocatedBytes();
}

void Renderer::State::applyFog(LayeredImage& image) {
    report("fog", 0, 1);
    fog::applyToFrame(*fog, image, camera, scene.sky.radiance);
    for (const gpu::PassTime& pass : fog->takeTimes()) addTime(statistics.passes, pass);
    statistics.gpuBytes = context.allocatedBytes();
    report("fog", 1, 1);
}

LayeredImage Renderer::draw() {
    State& s = *state_;
    const auto start = Clock::now();
    LayeredImage image = draw::skyImage(s.camera, s.scene.sun, s.scene.sky);
    s.statistics.passes.clear();
    if (s.photons) {
        s.photons->settle();
        for (const gpu::PassTime& pass : s.photons->times()) addTime(s.statistics.passes, pass);
    }
    if (s.billboards || s.march) {
        s.drawLight(photon::Part::all);
        s.drawBands(image, draw::allBands(s.camera), s.report);
    }
    if (s.fog) s.applyFog(image);
    s.statistics.drawSeconds += secondsSince(start);
    return image;
}

/// Of the passes that were drawn last.
double Renderer::State::passSeconds() const {
    double milliseconds = 0.0;
    for (const PassTime& pass : statistics.passes) milliseconds += pass.milliseconds;
    return 1e-3 * milliseconds;
}

Preview Renderer::preview() {
    State& s = *state_;
    Preview preview;
    const std::vector<draw::Band> bands = draw::sampleBands(s.camera);
    for (const draw::Band& band : bands)
        for (int row = 0; row < band.rows; ++row) preview.rows.push_back(band.first + row);
    preview.evenGenerations = s.photons->halves().even;
    preview.oddGenerations = s.photons->halves().odd;
    for (const photon::Part part : {photon::Part::even, photon::Part::odd}) {
        auto start = Clock::now();
        LayeredImage& image = part == photon::Part::even ? preview.even : preview.odd;
        image = draw::skyImage(s.camera, s.scene.sun, s.scene.sky);
        s.drawLight(part);
        const double whole = secondsSince(start);
        s.statistics.passes.clear();
        s.drawBands(image, bands, noReport);
        // the first of the two also pays for what is made once
        preview.forecastSeconds = whole + s.passSeconds() * s.camera.height / static_cast<double>(preview.rows.size());
    }
    return preview;
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
