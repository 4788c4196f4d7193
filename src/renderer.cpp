#include "renderer.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/error.h"
#include "base/interrupt.h"
#include "draw/sky.h"
#include "draw/view.h"
#include "renderer_state.h"
#include "volume/load.h"

namespace lumulus {

namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

constexpr double degrees = 3.14159265358979323846 / 180.0;

/// Rows drawn at once, in whole tiles: few enough that progress and Ctrl-C do not wait long, and 2^18 pixels at most.
int bandRows(const Tile& tile) {
    constexpr int bands = 32;
    const int tiles = (tile.height + bands * shared::TILE_EDGE - 1) / (bands * shared::TILE_EDGE);
    const int most = (1 << 18) / (tile.width * shared::TILE_EDGE);
    return std::max(1, std::min(tiles, most)) * shared::TILE_EDGE;
}

void addTime(std::vector<PassTime>& times, const gpu::PassTime& pass) {
    const auto known = std::find_if(times.begin(), times.end(), [&](const PassTime& t) { return t.name == pass.name; });
    if (known == times.end())
        times.push_back({pass.name, pass.milliseconds});
    else
        known->milliseconds += pass.milliseconds;
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
    photon::Options options;
    options.photonsPerGeneration = each;
    options.generations = wanted.generations;
    options.firstGeneration = static_cast<std::uint32_t>(wanted.firstGeneration);
    options.bands = wanted.bands;
    options.seed = wanted.seed;
    options.keepRing = keepRing;
    options.check = check;
    options.memoryBudget = static_cast<std::uint64_t>(std::ldexp(wanted.memoryBudget, 20));
    photons.emplace(context, *cloud, medium, options);
}

Renderer::Renderer(const scene::Scene& scene, const RendererOptions& options)
    : state_(std::make_unique<State>(scene, options)) {
    State& s = *state_;
    s.statistics.device = s.context.device().name;
    if (scene.clouds.empty()) {
        makeCamera(scene.camera, scene.image, Bounds{});  // what is wrong with it shows before the work
        return;
    }
    auto start = Clock::now();
    CloudVolume loaded = loadCloudVolume(scene.clouds[0], scene.preparation.memoryBudget, s.report);
    s.statistics.warnings = std::move(loaded.warnings);
    s.statistics.loadSeconds = secondsSince(start);
    s.bounds = boundsOf(loaded.volume);
    makeCamera(scene.camera, scene.image, s.bounds);
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
    if (s.photons) s.photons->trace(s.scene.sun, s.scene.sky);
    ++s.sinceChange;
    s.statistics.traceSeconds += secondsSince(start);
}

void Renderer::State::prepareDrawing() {
    const draw::DrawFeatures features{!medium.tables.oneTurnH.empty(), scatters() && hasSun(), photons.has_value(),
                                      medium.albedo == glm::dvec3(medium.albedo.x)};
    if (features.sun) sunDepth.emplace(context, *cloud);
    phase.emplace(context, medium.tables);
    if (scene.draw.mode == scene::DrawMode::billboards) {
        billboards.emplace(context, *cloud, features);
        if (features.sun) collectorSun.emplace(context, *cloud);
    } else {
        march.emplace(context, *cloud, features);
    }
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
void Renderer::State::recordLight() {
    if (sunDepth && !sunDrawn) {
        sunDepth->record(commands, -scene.sun.directionTo, medium.extinction);
        if (collectorSun) {
            commands.barrier("sun depths");
            collectorSun->record(commands, *sunDepth);
        }
        sunDrawn = true;
    }
    if (photons) {
        if (const std::uint64_t seen = std::max<std::uint64_t>(1, photons->photonsInRing());
            seen != lightFieldPhotons) {
            lightField.emplace(context, *cloud, seen);
            lightFieldPhotons = seen;
        }
        photons->reconstruct(commands, eyeVoxel());
        commands.barrier("collector radiance");
        lightField->record(commands, photons->radiance());
    }
}

void Renderer::State::drawBand(LayeredImage& image, const draw::FrameInputs& inputs, gpu::Buffer& params, int firstRow,
                               int rows) {
    shared::DrawParams values{};
    values.view = draw::viewParams(camera);
    values.light = draw::lightParams(scene.sun, scene.sky, medium.albedo, medium.tables);
    values.field = fieldParams();
    values.firstColumn = tile.x;
    values.columns = tile.width;
    values.firstRow = tile.y + firstRow;
    values.rows = rows;
    values.samples = raysAcross;
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
    draw::copyPixels(inputs.pixels.mapped<const shared::Pixel>(), image, firstRow, rows);
}

void Renderer::State::drawCloud(LayeredImage& image) {
    if (sunDepth || photons) {
        commands.begin();
        recordLight();
        commands.submit();
        commands.wait();
        for (const gpu::PassTime& pass : commands.times()) addTime(statistics.passes, pass);
    }
    if (billboards)
        billboards->prepare(camera, medium.extinction,
                            collectorSun ? collectorSun->values() : std::span<const float>());
    const int band = bandRows(tile);
    gpu::Buffer params(context, "draw params", sizeof(shared::DrawParams), gpu::Memory::host);
    const gpu::Buffer pixels(
        context, "pixels",
        static_cast<std::uint64_t>(band) * static_cast<std::uint64_t>(tile.width) * sizeof(shared::Pixel),
        gpu::Memory::host);
    // Stands for fields that the scene does not have: the shaders never read it, but every binding must be there.
    const gpu::Image none(context, "none", glm::ivec3(1), VK_FORMAT_R32G32B32A32_SFLOAT);
    const draw::FrameInputs inputs{params, *phase, lightField ? lightField->image() : none,
                                   sunDepth ? sunDepth->image() : none, pixels};
    const auto bands = static_cast<std::uint64_t>((tile.height + band - 1) / band);
    report("drawing", 0, bands);
    for (std::uint64_t done = 0; done < bands; ++done) {
        check();
        const int row = static_cast<int>(done) * band;
        drawBand(image, inputs, params, row, std::min(band, tile.height - row));
        report("drawing", done + 1, bands);
    }
    statistics.gpuBytes = context.allocatedBytes();
}

LayeredImage Renderer::draw() {
    return draw(sceneView());
}

View Renderer::sceneView() const {
    View view;
    view.camera = state_->scene.camera;
    view.image = state_->scene.image;
    return view;
}

int Renderer::raysAcross(const View& view) const {
    const State& s = *state_;
    if (!s.cloud) return 1;
    const glm::dvec3 centre = s.cloud->toWorld.point(0.5 * glm::dvec3(s.cloud->size));
    return std::min(view.mostRays,
                    draw::raysAcross(makeCamera(view, s.bounds), centre, std::cbrt(s.cloud->voxelVolume)));
}

const Bounds& Renderer::bounds() const {
    return state_->bounds;
}

LayeredImage Renderer::draw(const View& view) {
    State& s = *state_;
    const auto start = Clock::now();
    s.camera = makeCamera(view, s.bounds);
    s.tile = drawnTile(view);
    s.raysAcross = raysAcross(view);
    LayeredImage image = draw::skyImage(s.camera, s.tile, s.scene.sun, s.scene.sky);
    s.statistics.passes.clear();
    if (s.photons) {
        s.photons->settle();
        for (const gpu::PassTime& pass : s.photons->times()) addTime(s.statistics.passes, pass);
    }
    if (s.billboards || s.march) s.drawCloud(image);
    s.statistics.drawSeconds += secondsSince(start);
    return image;
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
