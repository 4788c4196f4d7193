#include "render/world.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/stopwatch.h"
#include "light/photon/emission.h"
#include "medium/fog_media.h"
#include "medium/phase_note.h"
#include "view/camera.h"
#include "volume/load.h"

namespace lumulus {

namespace {

constexpr double degrees = 3.14159265358979323846 / 180.0;

phase::ScatteringMedium makeMedium(const scene::Scene& scene, const scene::Cloud& from, double maximum) {
    phase::ScatteringMedium medium;
    medium.extinction = from.extinction * from.densityScale * maximum;
    medium.albedo = from.albedo;
    medium.tables = phase::makeScatteringTables(from.phase, scene.photonMap.forwardCut * degrees, from.albedo,
                                                scene.photonMap.bands, scene.sun.angularDiameter * degrees);
    return medium;
}

/// Area of the surface of an instance's box [m²]: light that fills the world falls on instances in proportion to it.
double surfaceArea(const cloud::Instance& instance) {
    const glm::dmat3 faces = photon::faceAreas(instance.voxelToMetres, glm::dvec3(instance.asset->size));
    return glm::length(faces[0]) + glm::length(faces[1]) + glm::length(faces[2]);
}

/// Makes a world step by step.
class Maker {
  public:
    Maker(gpu::Context& context, const scene::Scene& scene, const WorldOptions& options, WorldReport& report)
        : context_(context),
          scene_(scene),
          options_(options),
          report_(report),
          world_{scene.fog,      {scene.sun, {scene.sky, scene.ground, scene.sun.angularDiameter}}, {}, {}, {}, {},
                 glm::dvec3(0.0)} {}

    World make() {
        const Stopwatch loading;
        const CloudVolumes volumes = load();
        const std::vector<vdb::PlacedVolume> placed = volumes.placed();
        report_.loadSeconds = loading.seconds();
        makeCamera(scene_.camera, scene_.image, world_.bounds);  // what is wrong with it shows before the work
        const Stopwatch preparing;
        world_.light.resize(world_.instances.size());
        for (std::size_t i = 0; i < placed.size(); ++i) prepare(i, placed[i]);
        findReachingLight(world_);
        for (const std::size_t i : world_.visible()) lightUp(i);
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
        for (const std::size_t i : world_.visible()) lightUp(i);
        return std::move(world_);
    }

  private:
    /// The volumes of all clouds; places the instances.
    CloudVolumes load();
    void prepare(std::size_t number, const vdb::PlacedVolume& placed);
    const cloud::Asset* findAsset(std::size_t number, const vdb::Volume* volume, double reducedExtinction) const;
    void lightUp(std::size_t number);

    gpu::Context& context_;
    const scene::Scene& scene_;
    const WorldOptions& options_;
    WorldReport& report_;
    World world_;
    /// What each instance's asset was prepared from.
    struct Prepared {
        const vdb::Volume* volume = nullptr;
        double reducedExtinction = 0.0;
    };
    std::vector<Prepared> prepared_;
};

CloudVolumes Maker::load() {
    CloudVolumes volumes = loadClouds(scene_, options_.report, options_.check);
    report_.warnings = std::move(volumes.warnings);
    for (const scene::Cloud& cloud : scene_.clouds)
        if (auto note = phase::normalisationNote(cloud.phase)) report_.warnings.push_back(std::move(*note));
    report_.clouds = summarise(scene_, volumes);
    if (options_.loaded) options_.loaded(report_.clouds, report_.warnings);
    std::vector<Bounds> bounds;
    for (const vdb::PlacedVolume& placed : volumes.placed()) {
        const std::size_t number = world_.instances.size();
        cloud::Instance instance;
        instance.name = scene::nameOf(scene_, number);
        instance.voxelToMetres = placed.toWorld.linear;
        instance.origin = placed.toWorld.translation;
        instance.bounds = boundsOf(placed);
        instance.sceneExtinction = scene_.clouds[number].extinction;
        bounds.push_back(instance.bounds);
        world_.instances.push_back(std::move(instance));
    }
    world_.bounds = unite(bounds);
    return volumes;
}

/// An asset that was prepared for another instance in the same way.
const cloud::Asset* Maker::findAsset(std::size_t number, const vdb::Volume* volume, double reducedExtinction) const {
    for (std::size_t i = 0; i < prepared_.size(); ++i)
        if (prepared_[i].volume == volume && prepared_[i].reducedExtinction == reducedExtinction &&
            world_.instances[i].voxelToMetres == world_.instances[number].voxelToMetres)
            return world_.instances[i].asset;
    return nullptr;
}

void Maker::prepare(std::size_t number, const vdb::PlacedVolume& placed) {
    cloud::Instance& instance = world_.instances[number];
    const vdb::Volume& volume = *placed.volume;
    prepared_.push_back({});
    if (volume.empty()) return;
    options_.report("preparing the cloud", 0, 1);
    instance.medium = makeMedium(scene_, scene_.clouds[number], static_cast<double>(volume.maximum));
    const phase::ScatteringMedium& medium = instance.medium;
    if (!(medium.extinction > 0.0)) return;
    cloud::PrepareOptions options;
    options.preparation = scene_.preparation;
    options.majorant = scene_.photonMap.majorant;
    const double forward = scene_.photonMap.bands > 1 ? static_cast<double>(medium.tables.bandMoments[1]) : 0.0;
    options.reducedExtinction =
        medium.extinction * static_cast<double>(medium.tables.scatterFraction) * (1.0 - forward);
    instance.asset = findAsset(number, &volume, options.reducedExtinction);
    if (instance.asset == nullptr) {
        world_.assets.push_back(std::make_shared<const cloud::Asset>(cloud::prepare(context_, placed, options)));
        instance.asset = world_.assets.back().get();
        if (instance.asset->tree.limited)
            report_.warnings.push_back("samples of the gradient asked for more than " +
                                       std::to_string(scene_.preparation.maxLeaves) +
                                       " collectors: light is smeared in those that stay too large; raise "
                                       "preparation.max_leaves or lower preparation.samples");
    }
    prepared_.back() = {&volume, options.reducedExtinction};
    stopIfInterrupted();
    options_.report("preparing the cloud", 1, 1);
}

/// What of the instance's light is made beforehand. Photons are shared out by what falls on each instance.
void Maker::lightUp(std::size_t number) {
    const cloud::Instance& instance = world_.instances[number];
    light::InstanceLight& light = world_.light[number];
    const bool scatters = instance.medium.scatters();
    if (scatters && world_.lights.hasSun()) light.shadow.emplace(context_, *instance.asset);
    if (!scatters || world_.lights.isDark()) return;
    const scene::PhotonMap& wanted = scene_.photonMap;
    double area = 0.0;
    const std::vector<std::size_t> visible = world_.visible();
    for (const std::size_t i : visible) area += surfaceArea(world_.instances[i]);
    const double share = visible.size() == 1 ? 1.0 : surfaceArea(instance) / area;
    const auto generations = static_cast<std::uint64_t>(wanted.generations);
    const auto photons = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(wanted.photons)));
    const std::uint64_t each = (photons + generations - 1) / generations;
    if (each > 0xF0000000ULL)
        throw InputError("a generation would hold " + std::to_string(each) + " photons, more than 4026531840",
                         "photon_map.photons", "ask for more generations or fewer photons");
    // progressive: as fine as any number of photons may ask for
    light.estimatorGrid =
        light::lightGrid(*instance.asset, options_.progressive ? std::numeric_limits<std::uint64_t>::max() : photons);
    photon::Options options;
    options.photonsPerGeneration = each;
    options.generations = wanted.generations;
    options.firstGeneration = static_cast<std::uint32_t>(wanted.firstGeneration);
    options.bands = wanted.bands;
    options.seed = wanted.seed + number;
    options.keepRing = options_.keepRing;
    options.splitGenerations = options_.progressive;
    options.estimates = light.estimatorGrid;
    options.check = options_.check;
    options.air = light.air.has_value();
    options.memoryBudget =
        static_cast<std::uint64_t>(std::ldexp(wanted.memoryBudget, 20)) / static_cast<std::uint64_t>(visible.size());
    light.photons.emplace(context_, *instance.asset, instance.medium, options);
    stopIfInterrupted();
}

}  // namespace

std::vector<std::size_t> World::visible() const {
    std::vector<std::size_t> numbers;
    for (std::size_t i = 0; i < instances.size(); ++i)
        if (instances[i].asset != nullptr) numbers.push_back(i);
    return numbers;
}

bool World::hasPhotons() const {
    return std::ranges::any_of(light, [](const light::InstanceLight& l) { return l.photons.has_value(); });
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

void findReachingLight(World& world) {
    const sky::Atmosphere* atmosphere = world.lights.environment.atmosphere();
    for (std::size_t i = 0; i < world.instances.size(); ++i) {
        const cloud::Instance& instance = world.instances[i];
        light::InstanceLight& light = world.light[i];
        light.sun = world.lights.sunAt(instance.bounds.centre, world.fog);
        if (atmosphere == nullptr || instance.asset == nullptr) continue;
        const glm::dvec3 middle = world.bounds.centre;
        const photon::Box box{instance.origin + instance.offset, instance.voxelToMetres,
                              glm::dvec3(instance.asset->size)};
        const sky::SkyMaps& maps = world.lights.skyMaps({middle.x, atmosphere->groundHeight(), middle.z});
        light.air = photon::makeAirLight(*atmosphere, maps, world.lights.sun, box);
        const glm::dvec3 inFog = world.fog.media.empty()
                                     ? glm::dvec3(1.0)
                                     : fog::sunTransmittance(world.fog, instance.bounds.centre, light.sun.directionTo);
        light.sun.irradiance = world.lights.sun.irradiance * inFog * light.air->mostSun;
    }
}

bool traceAll(World& world, const CutOff& cutOff) {
    const auto dropAll = [&world] {
        for (light::InstanceLight& light : world.light)
            if (light.photons) light.photons->drop();
        return false;
    };
    try {
        for (std::size_t i = 0; i < world.light.size(); ++i) {
            light::InstanceLight& light = world.light[i];
            const double extinction = world.instances[i].medium.extinction;
            if (light.photons && !light.photons->tryTrace(light.sun, world.lights.environment, cutOff, extinction,
                                                          light.air ? &*light.air : nullptr))
                return dropAll();
        }
    } catch (...) {
        dropAll();
        throw;
    }
    for (light::InstanceLight& light : world.light) {
        if (light.photons) light.photons->keep();
        light.changed();
    }
    return true;
}

}  // namespace lumulus
