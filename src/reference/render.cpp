#include "reference/render.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "reference/fingerprint.h"
#include "reference/ground.h"
#include "scene/ephemeris.h"
#include "scene/finish_lamps.h"
#include "scene/phase_table_file.h"
#include "view/ground.h"

namespace lumulus::reference {
namespace {

void addVector(Fingerprint& print, const glm::dvec3& v) {
    print.add(v.x).add(v.y).add(v.z);
}

void addCloud(Fingerprint& print, const scene::Cloud& cloud, const vdb::PlacedVolume& placed) {
    const vdb::Volume& volume = *placed.volume;
    print.add(volume.size.x).add(volume.size.y).add(volume.size.z);
    print.add(std::as_bytes(std::span(volume.density)));
    for (int axis = 0; axis < 3; ++axis) addVector(print, placed.toWorld.linear[axis]);
    addVector(print, placed.toWorld.translation);
    print.add(cloud.extinction * cloud.densityScale).add(cloud.phase.model).add(cloud.phase.g);
    print.add(cloud.phase.dropletDiameter).add(cloud.phase.effectiveRadius).add(cloud.phase.effectiveVariance);
    if (cloud.phase.model == scene::PhaseModel::table) {
        const scene::PhaseTable table = scene::readPhaseTable(cloud.phase.table);
        print.add(std::as_bytes(std::span(table.angles))).add(std::as_bytes(std::span(table.values)));
    }
    addVector(print, cloud.albedo);
}

void addCamera(Fingerprint& print, const Camera& camera) {
    print.add(camera.width).add(camera.height).add(camera.projection);
    print.add(camera.tanHalfFov).add(camera.orthographicHeight);
    addVector(print, camera.position);
    for (int axis = 0; axis < 3; ++axis) addVector(print, camera.axes[axis]);
}

void addFog(Fingerprint& print, const scene::Fog& fog) {
    print.add(static_cast<int>(fog.inscattering));
    for (const scene::FogMedium& medium : fog.media) {
        print.add(medium.kind).add(medium.g).add(medium.falloff).add(medium.radius);
        print.add(medium.bottom).add(medium.top);
        for (const glm::dvec3& v : {medium.scattering, medium.absorption, medium.emission, medium.direction,
                                    medium.offset, medium.center, medium.halfSize}) {
            addVector(print, v);
        }
    }
}

void addSurface(Fingerprint& print, const scene::Surface& surface) {
    print.add(surface.kind).add(surface.radius);
    for (const glm::dvec3& v : {surface.position, surface.normal, surface.albedo, surface.emission}) {
        addVector(print, v);
    }
}

void addAir(Fingerprint& print, const scene::Sky& sky) {
    print.add(sky.model).add(static_cast<int>(sky.hillaire)).add(sky.aerosolDepth).add(sky.angstrom).add(sky.ozone);
}

void addLamp(Fingerprint& print, const scene::Lamp& lamp) {
    print.add(lamp.kind).add(lamp.angle).add(lamp.softness).add(lamp.radius);
    for (const glm::dvec3& v : {lamp.position, lamp.direction, lamp.power}) addVector(print, v);
}

/// Meshes by their places and their triangles.
void addMeshes(Fingerprint& print, const mesh::Placed& meshes) {
    for (const mesh::Instance& instance : meshes.instances) {
        print.add(instance.model);
        for (int column = 0; column < 4; ++column) addVector(print, glm::dvec3(instance.toWorld[column]));
    }
    for (const mesh::Model& model : meshes.models) {
        print.add(std::as_bytes(std::span(model.vertices))).add(std::as_bytes(std::span(model.triangles)));
        print.add(std::as_bytes(std::span(model.materials)));
        for (const mesh::Texture& texture : model.textures) print.add(std::as_bytes(std::span(texture.texels)));
    }
}

/// The map by its name: its content is read once and not kept here.
void addMap(Fingerprint& print, const scene::Sky& sky) {
    const std::string name = sky.map.string();
    print.add(sky.model).add(sky.mapScale).add(sky.mapRotation).add(static_cast<int>(sky.mapSun));
    print.add(std::as_bytes(std::span(name)));
}

std::uint64_t fingerprintOf(const scene::Scene& scene, const std::vector<vdb::PlacedVolume>& volumes,
                            const Camera& camera, const mesh::Placed* meshes, Majorant majorant, std::uint64_t seed) {
    Fingerprint print;
    print.add(seed).add(majorant).add(scene.sun.angularDiameter);
    addVector(print, scene.sun.directionTo);
    if (scene.sun.refraction) print.add(scene.sun.refraction);
    addVector(print, scene.sun.irradiance);
    addVector(print, scene.sky.radiance);
    addCamera(print, camera);
    for (std::size_t i = 0; i < volumes.size(); ++i) addCloud(print, scene.clouds[i], volumes[i]);
    if (!scene.fog.media.empty()) addFog(print, scene.fog);
    for (const scene::Surface& surface : surfacesOf(scene)) addSurface(print, surface);
    for (const scene::Lamp& lamp : scene.lamps) {
        if (lamp.shines()) addLamp(print, lamp);
    }
    if (scene.sun.limbDarkening) print.add(1);
    if (scene.sky.model == scene::SkyModel::atmosphere) addAir(print, scene.sky);
    if (scene.moon.shines) {
        addVector(print, scene.moon.directionTo);
        print.add(scene.moon.phaseAngle);
    }
    if (scene.sky.model == scene::SkyModel::map) addMap(print, scene.sky);
    if (!scene.image.background) print.add(scene.image.background);
    if (meshes != nullptr) addMeshes(print, *meshes);
    return print.value();
}

}  // namespace

Renderer::Renderer(const scene::Scene& scene, const std::vector<vdb::PlacedVolume>& volumes, Majorant majorant,
                   std::uint64_t seed, int scatterings)
    : camera_(makeCamera(scene.camera, scene.image, boundsOf(volumes))),
      tracer_(groundedScene(scene, boundsOf(volumes)), volumes, majorant, scatterings),
      skyUnit_(tracer_.skyUnit()),
      discUnit_(tracer_.discUnit()),
      background_(scene.image.background),
      discCover_(camera_, scene.sun.refraction ? scene::apparentDirection(scene.sun) : tracer_.sun().direction(),
                 tracer_.sunny() ? tracer_.sun().radius() : 0.0),
      lamps_(scene, camera_),
      seed_(seed),
      fingerprint_(
          fingerprintOf(groundedScene(scene, boundsOf(volumes)), volumes, camera_, tracer_.meshes(), majorant, seed)) {
    if (scatterings != allScatterings) fingerprint_ = Fingerprint().add(fingerprint_).add(scatterings).value();
    scene::requireEyeOutsideLamps(scene, camera_.position);
    film_.width = scene.image.width;
    film_.height = scene.image.height;
    pass_.resize(static_cast<std::size_t>(film_.width) * static_cast<std::size_t>(film_.height));
    film_.pixels.resize(pass_.size());
}

void Renderer::resume(Film film) {
    assert(film.pixels.size() == film_.pixels.size());
    film_ = std::move(film);
}

Renderer::Sample Renderer::sample(int x, int y) const {
    const auto pixel =
        static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(film_.width) + static_cast<std::uint64_t>(x);
    Random random(seed_, pixel, film_.samples);
    const double px = x + random.uniform(), py = y + random.uniform();
    const Ray ray = camera_.ray(px, py);
    const PathSample path = tracer_.trace(ray, random);
    Sample result;
    result.lost = path.lost;
    result.sums.scattered = path.radiance;
    if (background_) result.sums.passed = path.passed;
    if (isLineSample(film_.samples)) {
        const RayIntegrals line = tracer_.integrate(ray);
        result.sums.transmittance = line.transmittance;
        result.sums.clear = line.clear;
        result.sums.distance = line.distance;
    }
    result.sums.scattered += lamps_.seen(tracer_, camera_, path, {x, y}, random);
    if (const DiscCover::Pixel* covered = discCover_.find(x, y)) {
        const glm::dvec2 place = covered->sample(random);
        const glm::dvec3 seen = tracer_.discSeen(camera_.ray(place.x, place.y));
        if (background_) result.sums.disc = covered->share * seen;
        result.sums.discShare = covered->share;
    }
    const glm::dvec3 radiance = result.sums.scattered + result.sums.passed * skyUnit_ + result.sums.disc * discUnit_;
    result.sums.square = radiance * radiance;
    return result;
}

bool Renderer::pass(const Continue& goOn) {
    // bands of about this many paths take less than a second, in dense fog some seconds, until an interrupt is noticed
    const int bandPaths = tracer_.hazy() ? 1 << 12 : 1 << 15;
    const int rows = std::clamp(bandPaths / film_.width, 1, film_.height);
    for (int begin = 0; begin < film_.height; begin += rows) {
        const int end = std::min(begin + rows, film_.height);
        tbb::parallel_for(begin * film_.width, end * film_.width, [&](int pixel) {
            pass_[static_cast<std::size_t>(pixel)] = sample(pixel % film_.width, pixel / film_.width);
        });
        if (!goOn(static_cast<std::uint64_t>(end - begin))) return false;
    }
    for (std::size_t i = 0; i < pass_.size(); ++i) {
        PixelSums& sums = film_.pixels[i];
        const PixelSums& added = pass_[i].sums;
        sums.scattered += added.scattered;
        sums.square += added.square;
        sums.passed += added.passed;
        sums.disc += added.disc;
        sums.discShare += added.discShare;
        sums.transmittance += added.transmittance;
        sums.clear += added.clear;
        sums.distance += added.distance;
        film_.lost += pass_[i].lost ? 1 : 0;
    }
    ++film_.samples;
    return true;
}

LayeredImage Renderer::picture() const {
    LayeredImage image = reference::picture(film_, skyUnit_, discUnit_, background_);
    std::vector<float>& front = image.layer("depth.front");
    tbb::parallel_for(0, film_.width * film_.height, [&](int pixel) {
        const Ray middle = camera_.ray(pixel % film_.width + 0.5, pixel / film_.width + 0.5);
        front[static_cast<std::size_t>(pixel)] = static_cast<float>(tracer_.front(middle).value_or(farDepth));
    });
    return image;
}

}  // namespace lumulus::reference
