#include "render/world.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/stopwatch.h"
#include "light/light_field.h"
#include "light/photon/ground.h"
#include "render/importance.h"
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

/// Makes a world step by step.
class Maker {
  public:
    Maker(gpu::Context& context, const scene::Scene& scene, const WorldOptions& options, WorldReport& report)
        : context_(context),
          scene_(scene),
          options_(options),
          report_(report),
          world_{scene.fog, {scene.sun, scene.sky, scene.ground}, {}, {}, {}, {}, {}, {}, {}, glm::dvec3(0.0)} {}

    World make() {
        const Stopwatch loading;
        const CloudVolumes volumes = load();
        const std::vector<vdb::PlacedVolume> placed = volumes.placed();
        report_.loadSeconds = loading.seconds();
        makeCamera(scene_.camera, scene_.image, world_.bounds);  // what is wrong with it shows before the work
        const Stopwatch preparing;
        world_.light.resize(world_.instances.size());
        for (std::size_t i = 0; i < placed.size(); ++i) {
            world_.light[i].sun = world_.lights.sunAt(world_.instances[i].bounds.centre, world_.fog);
            prepare(i, placed[i]);
        }
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
            world_.light[i].sun = world_.lights.sunAt(instance.bounds.centre, world_.fog);
        }
        lightUp();
        return std::move(world_);
    }

  private:
    /// The volumes of all clouds; places the instances.
    CloudVolumes load();
    void prepare(std::size_t number, const vdb::PlacedVolume& placed);
    const cloud::Asset* findAsset(std::size_t number, const vdb::Volume* volume, double reducedExtinction) const;
    void lightUp();
    photon::Options photonOptions() const;
    void makePhotonMap(const std::vector<std::size_t>& visible);

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
    options.keepBlocks = scene_.clouds.size() > 1;
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

/// What of the light is made beforehand.
void Maker::lightUp() {
    const std::vector<std::size_t> visible = world_.visible();
    if (visible.size() > 1) {
        std::vector<const cloud::Instance*> instances;
        for (const std::size_t i : visible) instances.push_back(&world_.instances[i]);
        world_.sharedVolumes = std::make_unique<cloud::SharedVolumes>(cloud::makeSharedVolumes(context_, instances));
    }
    bool scatters = false;
    for (const std::size_t i : visible) {
        const cloud::Instance& instance = world_.instances[i];
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
    options.ground = scene_.ground.has_value();
    options.splitGenerations = options_.progressive;
    options.check = options_.check;
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

/// Where the instances are now, and what of the sun's light reaches them.
std::vector<photon::Placement> placements(const World& world, const std::vector<std::size_t>& visible) {
    std::vector<photon::Placement> places;
    for (const std::size_t i : visible) {
        const cloud::Instance& instance = world.instances[i];
        const glm::dvec3 &reaching = world.light[i].sun.irradiance, &whole = world.lights.sun.irradiance;
        photon::Placement place{instance.origin + instance.offset, instance.medium.extinction, glm::dvec3(1.0)};
        for (int channel = 0; channel < 3; ++channel)
            if (whole[channel] > 0.0) place.sunShare[channel] = reaching[channel] / whole[channel];
        places.push_back(place);
    }
    return places;
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

bool traceAll(World& world, const CutOff& cutOff, const photon::Ground* ground) {
    if (world.photons) {
        const std::vector<std::size_t> visible = world.visible();
        const cloud::Instance& first = world.instances[visible.front()];
        scene::Sun sun = world.lights.sun;
        if (visible.size() > 1)
            world.photons->place(placements(world, visible));
        else
            sun = world.light[visible.front()].sun;
        if (ground != nullptr) {
            photon::Ground below = *ground;
            below.corner = visible.size() > 1 ? world.photons->corner() : first.origin + first.offset;
            world.photons->setGround(below);
        }
        if (!world.photons->tryTrace(sun, world.lights.environment, cutOff, first.medium.extinction)) return false;
        world.photons->keep();
    }
    for (light::InstanceLight& light : world.light) light.changed();
    return true;
}

}  // namespace lumulus
