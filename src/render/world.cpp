#include "render/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "base/error.h"
#include "base/stopwatch.h"
#include "cloud/bricks.h"
#include "light/light_field.h"
#include "medium/phase_note.h"
#include "render/importance.h"
#include "render/inexact_light.h"
#include "render/world_assets.h"
#include "render/world_fog.h"
#include "view/camera.h"
#include "view/ground.h"
#include "volume/load.h"

namespace lumulus {

namespace {

/// An atmosphere has its planet's ground, with the albedo and height of the scene's; it is no part of the scene then.
light::LightSet lightsOf(const scene::Scene& scene, KeptClouds::State* kept) {
    KeptAir none;
    const sky::Environment environment = (kept != nullptr ? kept->air : none).environmentOf(scene);
    std::optional<scene::Ground> ground = scene.ground, planet;
    if (environment.atmosphere() != nullptr) {
        planet = scene.ground.value_or(scene::Ground{scene.sky.groundAlbedo, 0.0});
        ground.reset();
    }
    return {environment.sunOf(scene.sun), environment, ground, planet};
}

/// An instance as cloud `number` of the scene has it now.
cloud::Instance editedInstance(const cloud::Instance& from, const scene::Scene& scene, std::size_t number,
                               const CloudOrigin& origin, const scene::Sun& sun, const scene::PhotonMap& map) {
    const scene::Cloud& cloud = scene.clouds[number];
    cloud::Instance instance = from;
    instance.name = scene::nameOf(scene, number);
    instance.offset = glm::dvec3(0.0);
    if (instance.sceneExtinction > 0.0) instance.medium.extinction *= cloud.extinction / instance.sceneExtinction;
    instance.sceneExtinction = cloud.extinction;
    if (origin.substance && instance.asset != nullptr) setSubstance(instance, map, cloud, sun);
    if (!origin.added) return instance;
    const double sine = origin.scale * std::sin(origin.yaw), cosine = origin.scale * std::cos(origin.yaw);
    const glm::dmat3 turned(cosine, 0.0, -sine, 0.0, origin.scale, 0.0, sine, 0.0, cosine);
    const glm::dvec3 middle = from.bounds.centre;
    instance.voxelToMetres = turned * from.voxelToMetres;
    instance.origin = middle + turned * (from.origin - middle) + origin.move;
    instance.bounds =
        movedBounds(from.bounds, {from.voxelToMetres, from.origin}, {instance.voxelToMetres, instance.origin});
    return instance;
}

/// Makes a world step by step.
class Maker {
  public:
    Maker(gpu::Context& context, const scene::Scene& scene, const WorldOptions& options, WorldReport& report)
        : context_(context),
          scene_(scene),
          options_(options),
          report_(report),
          world_{.fog = scene.fog, .lights = {scene.sun, sky::Environment(scene::Sky())}} {}

    World make() {
        const Stopwatch loading;
        CloudVolumes volumes = load();
        standOnGround(world_.bounds);
        report_.loadSeconds = loading.seconds();
        makeCamera(scene_.camera, scene_.image, world_.bounds);  // what is wrong with it shows before the work
        const Stopwatch preparing;
        const std::shared_ptr<const gpu::Image> pool = options_.kept != nullptr
                                                           ? options_.kept->poolOf(context_, volumes, options_.check)
                                                           : makePool(context_, volumes.bricks, options_.check);
        world_.light.resize(world_.instances.size());
        if (options_.kept != nullptr) world_.fields = options_.kept->fields;
        prepareAssets(context_, scene_, volumes, pool, options_, world_, report_);
        warnOfUnresolvedVoxels(world_, report_);
        findReachingLight(world_);
        lightUp();
        if (!volumes.clouds.empty()) report_.prepareSeconds = preparing.seconds();
        return std::move(world_);
    }

    World makeEdited(World& other, std::span<const CloudOrigin> origins) {
        world_.assets = other.assets;
        world_.photonMap = other.photonMap;
        world_.fields = other.fields;
        standOnGround(other.bounds);
        std::vector<Bounds> bounds;
        for (std::size_t i = 0; i < origins.size(); ++i) {
            world_.instances.push_back(editedInstance(other.instances.at(origins[i].from), scene_, i, origins[i],
                                                      world_.lights.sun, world_.photonMap));
            bounds.push_back(world_.instances.back().bounds);
        }
        world_.bounds = unite(bounds);
        world_.light.resize(world_.instances.size());
        shareFogLight(world_, other);
        findReachingLight(world_);
        before_ = {&other, origins};
        lightUp();
        if (world_.photons && other.photons) world_.photons->goOnFrom(*other.photons, partsBefore());
        return std::move(world_);
    }

    World makeBeside(const World& other) {
        world_.assets = other.assets;
        world_.photonMap = other.photonMap;
        world_.photonMap.firstGeneration = scene_.photonMap.firstGeneration;
        world_.instances = other.instances;
        world_.bounds = other.bounds;
        standOnGround(world_.bounds);
        world_.light.resize(world_.instances.size());
        for (std::size_t i = 0; i < world_.instances.size(); ++i) {
            cloud::Instance& instance = world_.instances[i];
            const double wanted = scene_.clouds[i].extinction;
            if (instance.sceneExtinction != wanted) instance.medium.extinction *= wanted / instance.sceneExtinction;
            instance.sceneExtinction = wanted;
            instance.offset = glm::dvec3(0.0);
            world_.light[i].shadowTexel = other.light[i].shadowTexel;
            world_.light[i].fewestCells = other.light[i].fewestCells;
        }
        world_.levelsOfDetail = other.levelsOfDetail;
        shareFogLight(world_, other);
        findReachingLight(world_);
        lightUp();
        return std::move(world_);
    }

  private:
    /// Lights and fog, with the ground below clouds that lie within these bounds.
    void standOnGround(const Bounds& clouds) {
        const scene::Scene grounded = groundedScene(scene_, clouds);
        world_.lights = lightsOf(grounded, options_.kept);
        world_.fog = grounded.fog;
    }
    /// The volumes of all clouds; places the instances.
    CloudVolumes load();
    void lightUp();
    photon::Options photonOptions() const;
    void makePhotonMap(const std::vector<std::size_t>& visible);
    std::optional<std::size_t> partBefore(std::size_t instance) const;
    std::vector<std::optional<std::size_t>> partsBefore() const;

    /// The world whose photons are kept, and which of its clouds the instances were.
    struct Before {
        const World* world = nullptr;
        std::span<const CloudOrigin> origins;
    };

    gpu::Context& context_;
    const scene::Scene& scene_;
    const WorldOptions& options_;
    WorldReport& report_;
    World world_;
    Before before_;
};

CloudVolumes Maker::load() {
    CloudVolumes volumes = options_.read ? options_.read(scene_)
                                         : loadClouds(scene_, options_.report, options_.check, FieldStorage::asWanted);
    report_.warnings = std::move(volumes.warnings);
    const scene::Phase* noted = nullptr;
    for (const scene::Cloud& cloud : scene_.clouds) {
        if (noted != nullptr && *noted == cloud.phase) continue;  // the many clouds of a field have one
        noted = &cloud.phase;
        if (auto note = phase::normalisationNote(cloud.phase)) report_.warnings.push_back(std::move(*note));
    }
    report_.clouds = summarise(scene_, volumes);
    warnOfBackwardPeaks(scene_, report_);
    if (options_.loaded) options_.loaded(report_.clouds, report_.warnings);
    std::vector<Bounds> bounds;
    std::unordered_map<const vdb::Volume*, std::pair<Bounds, vdb::Affine>> known;
    for (const vdb::PlacedVolume& placed : volumes.placed()) {
        const std::size_t number = world_.instances.size();
        const auto atPlace = [&] {
            return volumes.filled.empty() ? boundsOf(placed)
                                          : boundsOf(volumes.filled[volumes.clouds[number].volume], placed.toWorld);
        };
        cloud::Instance instance;
        instance.name = scene::nameOf(scene_, number);
        instance.voxelToMetres = placed.toWorld.linear;
        instance.origin = placed.toWorld.translation;
        const auto first = known.find(placed.volume);
        instance.bounds =
            first == known.end() ? atPlace() : movedBounds(first->second.first, first->second.second, placed.toWorld);
        known.try_emplace(placed.volume, instance.bounds, placed.toWorld);
        instance.sceneExtinction = scene_.clouds[number].extinction;
        bounds.push_back(instance.bounds);
        world_.instances.push_back(std::move(instance));
    }
    world_.bounds = unite(bounds);
    return volumes;
}

/// What of the light is made beforehand.
void Maker::lightUp() {
    world_.meshes = !scene_.meshes.empty();
    const std::vector<std::size_t> visible = world_.visible();
    if (visible.size() > 1) {
        std::vector<const cloud::Instance*> instances;
        for (const std::size_t i : visible) instances.push_back(&world_.instances[i]);
        world_.sharedVolumes = options_.kept != nullptr
                                   ? options_.kept->sharedVolumes(context_, instances)
                                   : std::make_shared<const cloud::SharedVolumes>(context_, instances);
    }
    bool scatters = false;
    std::unordered_map<const cloud::Asset*, std::shared_ptr<light::CellLayouts>> layouts;
    const auto massProgram = std::make_shared<light::MassProgramOnce>();
    for (const std::size_t i : visible) {
        const cloud::Instance& instance = world_.instances[i];
        const auto [of, isNew] = layouts.try_emplace(instance.asset);
        if (isNew) of->second = std::make_shared<light::CellLayouts>(massProgram);
        world_.light[i].layouts = of->second;
        const bool shades = visible.size() > 1 || instance.medium.scatters();
        scatters = scatters || instance.medium.scatters();
        if (shades && world_.lights.hasSun())
            world_.light[i].shadow.emplace(context_, *instance.asset, instance.voxelToMetres,
                                           world_.light[i].shadowTexel);
    }
    if (visible.size() > 1 && world_.hasShadows()) world_.sharedShadow.emplace(context_);
    if (scatters && !world_.lights.isDark()) makePhotonMap(visible);
    stopIfInterrupted();
}

photon::Options Maker::photonOptions() const {
    const scene::PhotonMap& wanted = world_.photonMap;
    const auto generations = static_cast<std::uint64_t>(wanted.generations);
    const auto photons = static_cast<std::uint64_t>(wanted.photons);
    const std::uint64_t each = (photons + generations - 1) / generations;
    if (each > 0xF0000000ULL)
        throw InputError("a generation would hold " + std::to_string(each) + " photons, more than 4026531840",
                         "photon_map.photons", "ask for more generations or fewer photons");
    photon::Options options;
    options.photonsPerGeneration = each;
    options.generations = wanted.generations;
    options.firstGeneration = static_cast<std::uint32_t>(wanted.firstGeneration);
    options.bands = wanted.bands;
    options.seed = wanted.seed;
    options.keepRing = options_.keepRing;
    options.ground = world_.shadedGround() != nullptr;
    options.meshes = world_.meshes && world_.lights.hasSun();
    options.splitGenerations = options_.progressive;
    options.check = options_.check;
    const std::optional<photon::AirLight>& air = world_.air ? world_.air : world_.light[world_.visible().front()].air;
    options.fog = world_.fogLight != nullptr;
    options.air = air.has_value();
    if (air) options.skyCells = air->skyFrame.size;
    options.memoryBudget = static_cast<std::uint64_t>(std::ldexp(wanted.memoryBudget, 20));
    return options;
}

/// The part of the photon map of before that an instance was; none where it is new.
std::optional<std::size_t> Maker::partBefore(std::size_t instance) const {
    if (before_.world == nullptr || !before_.world->photons || before_.origins[instance].added) return std::nullopt;
    return before_.world->light[before_.origins[instance].from].part;
}

std::vector<std::optional<std::size_t>> Maker::partsBefore() const {
    std::vector<std::optional<std::size_t>> parts;
    for (const std::size_t i : world_.visible()) parts.push_back(partBefore(i));
    return parts;
}

/// One map for all that is visible. Photons are shared out by what the picture shows of each instance.
void Maker::makePhotonMap(const std::vector<std::size_t>& visible) {
    photon::Options options = photonOptions();
    const std::vector<double> shares = photonShares(world_, visible, scene_, options_.keepRing);
    std::vector<photon::MapPart> parts;
    for (std::size_t k = 0; k < visible.size(); ++k) {
        const cloud::Instance& instance = world_.instances[visible[k]];
        const double photons =
            std::ceil(shares[k] * static_cast<double>(world_.photonMap.photons) * scene::mostFrames(world_.photonMap));
        // progressive: as fine as any number of photons may ask for
        const std::uint64_t most = options_.progressive
                                       ? std::numeric_limits<std::uint64_t>::max()
                                       : std::max<std::uint64_t>(1, static_cast<std::uint64_t>(photons));
        light::InstanceLight& light = world_.light[visible[k]];
        photon::MapPart part;
        part.asset = instance.asset;
        part.medium = instance.medium;
        part.voxelToMetres = instance.voxelToMetres;
        part.share = shares[k];
        part.collects = instance.medium.scatters();
        if (part.collects) {
            light.part = k;
            const auto before = partBefore(visible[k]);  // counts that are kept are of the same cells
            part.estimates = before ? before_.world->photons->parts()[*before].estimates
                                    : light::lightGrid(*instance.asset, most, light.fewestCells);
        }
        parts.push_back(std::move(part));
    }
    if (visible.size() > 1) {
        world_.photons.emplace(context_, std::move(parts), *world_.sharedVolumes, options);
        placeInstances(world_);
        return;
    }
    const photon::MapPart& only = parts.front();
    options.estimates = only.estimates;
    options.seed += visible.front();
    world_.photons.emplace(context_, *only.asset, only.voxelToMetres, only.medium, options);
}

}  // namespace

std::vector<std::size_t> World::visible() const {
    std::vector<std::size_t> numbers;
    for (std::size_t i = 0; i < instances.size(); ++i)
        if (instances[i].asset != nullptr) numbers.push_back(i);
    return numbers;
}

const scene::Ground* World::shadedGround() const {
    if (lights.ground) return &*lights.ground;
    const bool dense = std::ranges::none_of(assets, [](const auto& asset) { return asset->isSparse(); });
    return lights.planet && dense && (meshes || !assets.empty()) ? &*lights.planet : nullptr;
}

bool World::hasShadows() const {
    return std::ranges::any_of(light, [](const light::InstanceLight& l) { return l.shadow.has_value(); });
}

World makeWorld(gpu::Context& context, const scene::Scene& scene, const WorldOptions& options, WorldReport& report) {
    return Maker(context, scene, options, report).make();
}

World makeWorldBeside(gpu::Context& context, const scene::Scene& scene, const World& other,
                      const WorldOptions& options) {
    WorldReport report;
    return Maker(context, scene, options, report).makeBeside(other);
}

World makeEditedWorld(gpu::Context& context, const scene::Scene& scene, World& other,
                      std::span<const CloudOrigin> origins, const WorldOptions& options) {
    WorldReport report;
    return Maker(context, scene, options, report).makeEdited(other, origins);
}

}  // namespace lumulus
