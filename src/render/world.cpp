#include "render/world.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "base/error.h"
#include "base/stopwatch.h"
#include "cloud/bricks.h"
#include "light/light_field.h"
#include "light/photon/ground.h"
#include "medium/fog_media.h"
#include "medium/phase_note.h"
#include "render/importance.h"
#include "render/world_assets.h"
#include "view/camera.h"
#include "volume/load.h"

namespace lumulus {

namespace {

/// Share of the sun's light that fog lets through to an instance.
glm::dvec3 sunThroughFog(const World& world, const cloud::Instance& instance) {
    if (world.fog.media.empty()) return glm::dvec3(1.0);
    return fog::sunTransmittance(world.fog, instance.bounds.centre, world.lights.sun.directionTo);
}

/// Where the instances are now, and what of the sun's light reaches them; that which air takes differs by place, and
/// is not in it.
std::vector<photon::Placement> placements(const World& world, const std::vector<std::size_t>& visible) {
    std::vector<photon::Placement> places;
    for (const std::size_t i : visible) {
        const cloud::Instance& instance = world.instances[i];
        const glm::dvec3 &reaching = world.light[i].sun.irradiance, &whole = world.lights.sun.irradiance;
        photon::Placement place{instance.origin + instance.offset, instance.medium.extinction, glm::dvec3(1.0)};
        for (int channel = 0; channel < 3; ++channel)
            if (whole[channel] > 0.0) place.sunShare[channel] = reaching[channel] / whole[channel];
        if (world.air) place.sunShare = sunThroughFog(world, instance);
        places.push_back(place);
    }
    return places;
}

/// The ground that is no part of the sky: an atmosphere has its planet's, with the same albedo and height.
std::optional<scene::Ground> groundBelow(const scene::Scene& scene) {
    return scene.sky.model == scene::SkyModel::atmosphere ? std::nullopt : scene.ground;
}

/// Makes a world step by step.
class Maker {
  public:
    Maker(gpu::Context& context, const scene::Scene& scene, const WorldOptions& options, WorldReport& report)
        : context_(context),
          scene_(scene),
          options_(options),
          report_(report),
          world_{.fog = scene.fog,
                 .lights = {scene.sun, {scene.sky, scene.ground, scene.sun.angularDiameter}, groundBelow(scene)}} {}

    World make() {
        const Stopwatch loading;
        CloudVolumes volumes = load();
        const std::vector<vdb::PlacedVolume> placed = volumes.placed();
        report_.loadSeconds = loading.seconds();
        makeCamera(scene_.camera, scene_.image, world_.bounds);  // what is wrong with it shows before the work
        const Stopwatch preparing;
        const std::shared_ptr<const gpu::Image> pool = makePool(context_, volumes.bricks, options_.check);
        world_.light.resize(world_.instances.size());
        prepareAssets(context_, scene_, placed, pool, options_, world_, report_);
        findReachingLight(world_);
        lightUp();
        if (!placed.empty()) report_.prepareSeconds = preparing.seconds();
        return std::move(world_);
    }

    World makeBeside(const World& other) {
        world_.assets = other.assets;
        world_.instances = other.instances;
        world_.bounds = other.bounds;
        world_.light.resize(world_.instances.size());
        for (std::size_t i = 0; i < world_.instances.size(); ++i) {
            cloud::Instance& instance = world_.instances[i];
            const double wanted = scene_.clouds[i].extinction;
            if (instance.sceneExtinction != wanted) instance.medium.extinction *= wanted / instance.sceneExtinction;
            instance.sceneExtinction = wanted;
            instance.offset = glm::dvec3(0.0);
        }
        findReachingLight(world_);
        lightUp();
        return std::move(world_);
    }

  private:
    /// The volumes of all clouds; places the instances.
    CloudVolumes load();
    void lightUp();
    photon::Options photonOptions() const;
    void makePhotonMap(const std::vector<std::size_t>& visible);

    gpu::Context& context_;
    const scene::Scene& scene_;
    const WorldOptions& options_;
    WorldReport& report_;
    World world_;
};

CloudVolumes Maker::load() {
    CloudVolumes volumes = loadClouds(scene_, options_.report, options_.check, FieldStorage::asWanted);
    report_.warnings = std::move(volumes.warnings);
    const scene::Phase* noted = nullptr;
    for (const scene::Cloud& cloud : scene_.clouds) {
        if (noted != nullptr && *noted == cloud.phase) continue;  // the many clouds of a field have one
        noted = &cloud.phase;
        if (auto note = phase::normalisationNote(cloud.phase)) report_.warnings.push_back(std::move(*note));
    }
    report_.clouds = summarise(scene_, volumes);
    if (options_.loaded) options_.loaded(report_.clouds, report_.warnings);
    std::vector<Bounds> bounds;
    std::unordered_map<const vdb::Volume*, std::pair<Bounds, vdb::Affine>> known;
    for (const vdb::PlacedVolume& placed : volumes.placed()) {
        const std::size_t number = world_.instances.size();
        cloud::Instance instance;
        instance.name = scene::nameOf(scene_, number);
        instance.voxelToMetres = placed.toWorld.linear;
        instance.origin = placed.toWorld.translation;
        const auto first = known.find(placed.volume);
        instance.bounds = first == known.end() ? boundsOf(placed)
                                               : movedBounds(first->second.first, first->second.second, placed.toWorld);
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
    const std::vector<std::size_t> visible = world_.visible();
    if (visible.size() > 1) {
        std::vector<const cloud::Instance*> instances;
        for (const std::size_t i : visible) instances.push_back(&world_.instances[i]);
        world_.sharedVolumes = std::make_unique<cloud::SharedVolumes>(context_, instances);
    }
    bool scatters = false;
    std::unordered_map<const cloud::Asset*, std::shared_ptr<light::CellLayouts>> layouts;
    for (const std::size_t i : visible) {
        const cloud::Instance& instance = world_.instances[i];
        world_.light[i].layouts = layouts.try_emplace(instance.asset, world_.light[i].layouts).first->second;
        const bool shades = visible.size() > 1 || instance.medium.scatters();
        scatters = scatters || instance.medium.scatters();
        if (shades && world_.lights.hasSun())
            world_.light[i].shadow.emplace(context_, *instance.asset, instance.voxelToMetres);
    }
    if (visible.size() > 1 && world_.hasShadows()) world_.sharedShadow.emplace(context_);
    if (scatters && !world_.lights.isDark()) makePhotonMap(visible);
    stopIfInterrupted();
}

photon::Options Maker::photonOptions() const {
    const scene::PhotonMap& wanted = scene_.photonMap;
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
    options.ground = world_.lights.ground.has_value();
    options.splitGenerations = options_.progressive;
    options.check = options_.check;
    options.air = world_.lights.environment.atmosphere() != nullptr;
    options.memoryBudget = static_cast<std::uint64_t>(std::ldexp(wanted.memoryBudget, 20));
    return options;
}

/// One map for all that is visible. Photons are shared out by what the picture shows of each instance.
void Maker::makePhotonMap(const std::vector<std::size_t>& visible) {
    photon::Options options = photonOptions();
    const std::vector<double> shares = photonShares(world_, visible, scene_, options_.keepRing);
    std::vector<photon::MapPart> parts;
    for (std::size_t k = 0; k < visible.size(); ++k) {
        const cloud::Instance& instance = world_.instances[visible[k]];
        const double photons = std::ceil(shares[k] * static_cast<double>(scene_.photonMap.photons));
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
            part.estimates = light::lightGrid(*instance.asset, most);
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

bool World::hasShadows() const {
    return std::ranges::any_of(light, [](const light::InstanceLight& l) { return l.shadow.has_value(); });
}

namespace {

/// Maps of the sky above the middle of the clouds.
const sky::SkyMaps& skyMapsOf(World& world) {
    const glm::dvec3& middle = world.bounds.centre;
    return world.lights.skyMaps({middle.x, world.lights.environment.atmosphere()->groundHeight(), middle.z});
}

}  // namespace

World makeWorld(gpu::Context& context, const scene::Scene& scene, const WorldOptions& options, WorldReport& report) {
    return Maker(context, scene, options, report).make();
}

World makeWorldBeside(gpu::Context& context, const scene::Scene& scene, const World& other,
                      const WorldOptions& options) {
    WorldReport report;
    return Maker(context, scene, options, report).makeBeside(other);
}

void findReachingLight(World& world) {
    const sky::Atmosphere* atmosphere = world.lights.environment.atmosphere();
    const bool many = world.visible().size() > 1;
    glm::dvec3 lower(std::numeric_limits<double>::infinity()), upper = -lower;
    for (std::size_t i = 0; i < world.instances.size(); ++i) {
        const cloud::Instance& instance = world.instances[i];
        light::InstanceLight& light = world.light[i];
        light.sun = world.lights.sunAt(instance.bounds.centre, world.fog);
        if (atmosphere == nullptr || instance.asset == nullptr) continue;
        const photon::Box box{instance.origin + instance.offset, instance.voxelToMetres,
                              glm::dvec3(instance.asset->size)};
        light.air = photon::makeAirLight(*atmosphere, many ? nullptr : &skyMapsOf(world), world.lights.sun, box);
        light.sun.irradiance = world.lights.sun.irradiance * sunThroughFog(world, instance) * light.air->mostSun;
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 at(corner & 1, (corner >> 1) & 1, corner >> 2);
            const glm::dvec3 point = box.origin + box.edges * (at * box.size);
            lower = glm::min(lower, point), upper = glm::max(upper, point);
        }
    }
    if (atmosphere == nullptr || !many) return;
    const photon::Box all{lower, glm::dmat3(1.0), upper - lower};
    world.air = photon::makeAirLight(*atmosphere, &skyMapsOf(world), world.lights.sun, all);
}

void placeInstances(World& world) {
    const std::vector<std::size_t> visible = world.visible();
    if (world.photons && visible.size() > 1) world.photons->place(placements(world, visible));
}

bool traceAll(World& world, const CutOff& cutOff, const photon::Ground* ground) {
    if (world.photons) {
        const std::vector<std::size_t> visible = world.visible();
        const cloud::Instance& first = world.instances[visible.front()];
        const light::InstanceLight& only = world.light[visible.front()];
        scene::Sun sun = world.lights.sun;
        const photon::AirLight* air = only.air ? &*only.air : nullptr;
        if (visible.size() > 1) {
            placeInstances(world);
            air = world.air ? &*world.air : nullptr;
            if (air != nullptr) sun.irradiance *= air->mostSun;
        } else {
            sun = only.sun;
        }
        if (ground != nullptr) {
            photon::Ground below = *ground;
            below.corner = visible.size() > 1 ? world.photons->corner() : first.origin + first.offset;
            world.photons->setGround(below);
        }
        if (!world.photons->tryTrace(sun, world.lights.environment, cutOff, first.medium.extinction, air)) return false;
        world.photons->keep();
    }
    for (light::InstanceLight& light : world.light) light.changed();
    return true;
}

}  // namespace lumulus
