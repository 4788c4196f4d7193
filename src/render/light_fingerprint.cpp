#include "render/light_fingerprint.h"

#include <cstring>
#include <fstream>
#include <iterator>
#include <set>
#include <type_traits>

#include "base/error.h"
#include "base/version.h"
#include "gpu/transfer.h"
#include "service/values/sha256.h"

namespace lumulus {

namespace {

/// Hashes values by their bytes. Structs of the scene are taken apart by structured bindings, so that a member that
/// they get must be thought of here.
class Hash {
  public:
    template <class T>
    requires(std::is_arithmetic_v<T> || std::is_enum_v<T>) void add(const T& value) {
        sha_.update(std::as_bytes(std::span(&value, 1)));
    }
    template <int size, class T>
    void add(const glm::vec<size, T>& value) {
        for (int i = 0; i < size; ++i) add(value[i]);
    }
    void add(const glm::dmat3& value) {
        for (int i = 0; i < 3; ++i) add(value[i]);
    }
    void add(const std::string& text) { addBytes(std::as_bytes(std::span(text))); }
    void addBytes(std::span<const std::byte> bytes) {
        add(std::uint64_t{bytes.size()});
        sha_.update(bytes);
    }
    template <class... More>
    void all(const More&... values) {
        (add(values), ...);
    }
    /// The contents of a file; none has a name that is empty.
    void addFile(const std::filesystem::path& path) {
        if (path.empty()) return;
        std::ifstream file(path, std::ios::binary);
        const std::string content{std::istreambuf_iterator<char>(file), {}};
        if (!file) throw InputError("cannot read the file again", path.string(), "keep it until the picture is there");
        add(content);
    }

    void add(const scene::Sun& sun) {
        const auto& [directionTo, irradiance, diameter, refraction, limbDarkening] = sun;
        all(directionTo, irradiance, diameter, refraction, limbDarkening);
    }
    void add(const scene::Moon& moon) {
        const auto& [shines, directionTo, phaseAngle] = moon;
        all(shines, directionTo, phaseAngle);
    }
    void add(const scene::Ground& ground) {
        const auto& [albedo, height, foot] = ground;
        all(albedo, height, foot);
    }
    void add(const scene::Sky& sky) {
        const auto& [model, radiance, hillaire, aerosolDepth, angstrom, ozone, groundAlbedo, groundBelowClouds, map,
                     mapScale, mapRotation, mapSun] = sky;
        all(model, radiance, hillaire, aerosolDepth, angstrom, ozone, groundAlbedo, groundBelowClouds, mapScale,
            mapRotation, mapSun);
        if (model == scene::SkyModel::map) addFile(map);
    }
    void add(const scene::FogMedium& medium) {
        const auto& [kind, scattering, absorption, g, emission, falloff, direction, offset, center, radius, halfSize,
                     bottom, top] = medium;
        all(kind, scattering, absorption, g, emission, falloff, direction, offset, center, radius, halfSize, bottom,
            top);
    }
    void add(const scene::Phase& phase) {
        const auto& [model, g, diameter, radius, variance, table] = phase;
        all(model, g, diameter, radius, variance);
        addFile(table);
    }
    void add(const photon::MapPart& part) {
        all(part.asset->size, part.asset->format, part.voxelToMetres, part.medium.extinction, part.medium.albedo,
            part.estimates.edge, part.estimates.cells, part.share, part.collects);
    }
    void add(const cloud::Collector& collector) {
        const auto& [centre, mass, majorant, occupied, box] = collector;
        all(centre, mass, majorant, occupied, box.lower, box.upper);
    }
    void add(const scene::PhotonMap& map) {
        // the first generation tells which are traced, and not what they are; budget and what was given change nothing
        const auto& [photons, generations, first, bands, forwardCut, majorant, budget, seed, separate, transfer,
                     transferFrames, directionsGiven, photonsGiven] = map;
        all(photons, generations, bands, forwardCut, majorant, seed, separate);
        static_cast<void>(first), static_cast<void>(budget), static_cast<void>(transfer),
            static_cast<void>(transferFrames), static_cast<void>(directionsGiven), static_cast<void>(photonsGiven);
    }

    std::string hex() { return sha_.hex(); }

  private:
    service::Sha256 sha_;
};

void addImage(Hash& hash, gpu::Context& context, const gpu::Image& image) {
    hash.addBytes(gpu::download<std::byte>(context, image));
}

}  // namespace

std::string lightFingerprint(gpu::Context& context, const World& world, const scene::Scene& scene) {
    Hash hash;
    hash.add(std::string("lumulus map ") + version);
    hash.add(world.photonMap);
    hash.all(world.lights.sun, scene.moon, scene.sky);
    for (const auto& ground : {world.lights.ground, world.lights.planet}) {
        hash.add(ground.has_value());
        if (ground) hash.add(*ground);
    }
    for (const scene::FogMedium& medium : world.fog.media) hash.add(medium);
    if (world.photons)
        for (const photon::MapPart& part : world.photons->parts()) hash.add(part);
    std::set<const gpu::Image*> hashed;  // instances share assets, and assets their bricks
    const auto once = [&](const gpu::Image& image) {
        if (hashed.insert(&image).second) addImage(hash, context, image);
    };
    for (const std::size_t i : world.visible()) {
        const cloud::Instance& instance = world.instances[i];
        hash.all(instance.origin, instance.voxelToMetres, instance.medium.extinction, scene.clouds.at(i).phase);
        once(*instance.asset->density);
        if (instance.asset->bricks) once(*instance.asset->bricks);
        for (const cloud::Collector& collector : instance.asset->collectors) hash.add(collector);
    }
    return hash.hex();
}

}  // namespace lumulus
