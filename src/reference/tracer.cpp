#include "reference/tracer.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtx/component_wise.hpp>
#include <limits>
#include <type_traits>

#include "reference/haze_of.h"
#include "scene/fog_bounds.h"

namespace lumulus::reference {
namespace {

/// Collisions after which a path counts as lost, far more than any sane scene needs.
constexpr int collisionLimit = 100'000'000;

/// Collisions after which a path through fog counts as lost. Layers may be so thick, without absorption, that no light
/// comes through.
constexpr int fogCollisionLimit = 100'000;

/// Product of throughput, phase function and transmittance [1/sr] below which a shadow ray plays Russian roulette: few
/// rays carry most of the light of a forward lobe. Values between 0.02 and 0.1 are best in the Disney cloud.
constexpr double shadowThreshold = 0.05;

constexpr double endless = std::numeric_limits<double>::infinity();

double sumOf(const glm::dvec3& v) {
    return v.x + v.y + v.z;
}

double sumOf(const Four& v) {
    return v.x + v.y + v.z + v.w;
}

/// Russian roulette with this chance of going on; false where the path ends.
template <typename Light>
bool survives(Light& throughput, double chance, Random& random) {
    if (chance < 1.0) {
        if (random.uniform() >= chance) return false;
        throughput /= chance;
    }
    return true;
}

}  // namespace

template <typename Light>
BasicPathTracer<Light>::BasicPathTracer(const scene::Scene& scene, const std::vector<vdb::PlacedVolume>& volumes,
                                        Majorant majorant, int scatterings, bool meshesGlow)
    : environment_(scene),
      clouds_(scene.clouds, volumes, majorant),
      haze_(hazeOf(scene, environment_)),
      solids_(scene, meshesGlow),
      lamps_(withLamps(surfacesOf(scene), scene.lamps), scene.lamps),
      scatterings_(scatterings),
      inscattering_(scene.fog.inscattering) {
    scene::requireBoundedFog(scene);
    const PhaseFunction* phase = clouds_.narrowestPhase();
    if (environment_.sunny() && phase != nullptr)
        aureole_ = Aureole::of(*phase, environment_.sun().direction(), environment_.sun().radius());
}

template <typename Light>
auto BasicPathTracer<Light>::nextEvent(const Vertex& vertex, const Light& throughput, Random& random) const -> Event {
    Event event;
    if (!solids_.empty()) {
        const auto hit = solids_.nearest(vertex.ray, vertex.solid);
        if (hit) event = {Place::solid, hit->metres, Surfaces::none, *hit};
    }
    // what costs more comes later, when the way is shorter
    if constexpr (std::is_same_v<Haze, Fog>) {
        meetHaze(event, vertex, throughput, random);
        meetClouds(event, vertex, random);
    } else {
        meetClouds(event, vertex, random);
        meetHaze(event, vertex, throughput, random);
    }
    return event;
}

template <typename Light>
void BasicPathTracer<Light>::meetHaze(Event& event, const Vertex& vertex, const Light& throughput,
                                      Random& random) const {
    if (haze_.empty()) return;
    const auto collision = haze_.collide(vertex.ray, event.metres, throughput, random);
    if (collision) event = {Place::haze, collision->metres, collision->medium, {}};
}

template <typename Light>
void BasicPathTracer<Light>::meetClouds(Event& event, const Vertex& vertex, Random& random) const {
    const auto collision = clouds_.collide(vertex.voxels, event.metres, random);
    if (collision) event = {Place::cloud, collision->metres, collision->cloud, {}};
}

template <typename Light>
void BasicPathTracer<Light>::arrive(Vertex& vertex, const Event& event) const {
    vertex.place = event.place;
    vertex.index = event.index;
    vertex.arrived = vertex.ray.direction;
    vertex.ray.origin += event.metres * vertex.ray.direction;
    clouds_.advance(vertex.voxels, event.metres);
    vertex.solid =
        event.place == Place::solid ? solids_.at(vertex.ray.direction, vertex.ray.origin, event.solid) : SolidPoint{};
}

/// Follows the path through the haze to the event: adds emission and updates the throughput (after a collision with
/// haze, to the scattered part). Returns the share of the light that a collision leaves, 1 without a collision.
template <typename Light>
double BasicPathTracer<Light>::crossHaze(const Vertex& vertex, const Event& event, Light& radiance, Light& throughput,
                                         Random& random) const {
    radiance += haze_.emitted(vertex.ray, event.metres, throughput, random);
    if (event.place != Place::haze) {
        throughput = haze_.passed(vertex.ray, event.metres, throughput);
        return 1.0;
    }
    const Light scattered = haze_.scattered(vertex.ray, {event.metres, event.index}, throughput);
    const double share = sumOf(scattered) / sumOf(throughput);
    throughput = scattered;
    return share;
}

/// Updates the throughput after a collision with cloud or solid. Returns the remaining share of the brightest
/// channel.
template <typename Light>
double BasicPathTracer<Light>::scatter(const Vertex& vertex, Light& throughput) const {
    const bool solid = vertex.place == Place::solid;
    const Light albedo = environment_.albedo(solid ? solids_.albedo(vertex.solid) : clouds_.albedo(vertex.index));
    throughput *= albedo;
    return glm::compMax(albedo);
}

/// Of the cloud or the haze that the path has met.
template <typename Light>
const PhaseFunction& BasicPathTracer<Light>::phaseAt(const Vertex& vertex) const {
    return vertex.place == Place::haze ? haze_.phase(vertex.index) : clouds_.phase(vertex.index);
}

/// Draws the next direction of the path from the phase function, or as a solid reflects.
template <typename Light>
glm::dvec3 BasicPathTracer<Light>::turn(const Vertex& vertex, Random& random) const {
    if (vertex.place == Place::solid) return solids_.turn(vertex.solid, vertex.arrived, random);
    return turned(vertex.arrived, phaseAt(vertex).sample(random), random);
}

/// Share of light from `toLight` that goes on along the path, 1/sr: the phase function, or that of a solid. It
/// is also the density with which the function above draws that direction.
template <typename Light>
double BasicPathTracer<Light>::response(const Vertex& vertex, const glm::dvec3& toLight) const {
    if (vertex.place == Place::solid) return solids_.density(vertex.solid, vertex.arrived, toLight);
    return phaseAt(vertex).evaluate(oneMinusCosBetween(vertex.arrived, toLight));
}

/// What the phase function of droplets, or the facets of a mesh, make of the colours of light from a direction. Later
/// scattering events by the mean of the colours: many of them would multiply to weights without bounds, and their
/// colours have blurred by then.
template <typename Light>
Light BasicPathTracer<Light>::hue(const Path& path, const glm::dvec3& toLight) const {
    constexpr int most = 6;
    const Vertex& vertex = path.vertex;
    if (vertex.place == Place::solid && vertex.solid.mesh)
        return environment_.albedo(solids_.shade(vertex.solid, vertex.arrived, toLight));
    if (vertex.place != Place::cloud || path.collisions > most) return Light(1.0);
    return environment_.albedo(clouds_.phase(vertex.index).hue(oneMinusCosBetween(vertex.arrived, toLight)));
}

/// Density of paths that leave the vertex in a direction, 1/sr: by chance, and as branches to the aureole.
template <typename Light>
double BasicPathTracer<Light>::density(const Vertex& vertex, const glm::dvec3& direction) const {
    return response(vertex, direction) + (aureole_ ? aureole_->density(direction) : 0.0);
}

/// Continues the path in a direction that was drawn by chance or as a branch. Both kinds share the scattered light by
/// the balance heuristic, so that weights never grow. Where more paths go than light is expected from, Russian roulette
/// thins them out to weights of one over the importance. Returns false if the path ends.
template <typename Light>
bool BasicPathTracer<Light>::head(Path& path, const glm::dvec3& direction, Random& random) const {
    Vertex& vertex = path.vertex;
    const Light colours = hue(path, direction);
    path.throughput *= colours;
    // facets absorb by their colours: paths that go to and fro between them have to end
    if (vertex.solid.mesh &&
        !(glm::compMax(path.throughput) > 0.0 && survives(path.throughput, glm::compMax(colours), random)))
        return false;
    if (aureole_) {
        path.throughput *= response(vertex, direction) / density(vertex, direction);
        if (!survives(path.throughput, glm::compMax(path.throughput) * aureole_->importance(direction), random))
            return false;
    }
    vertex.ray.direction = direction;
    clouds_.turn(vertex.voxels, direction);
    return true;
}

/// Sends a branch of the path to the aureole after a scattering event.
template <typename Light>
void BasicPathTracer<Light>::branch(const Path& path, std::vector<Path>& branches, Random& random) const {
    Path other = path;
    if (head(other, aureole_->sample(random), random)) branches.push_back(std::move(other));
}

/// Emission of a surface that a path from `vertex` meets by chance, without the share that `lampLight` covers.
template <typename Light>
Light BasicPathTracer<Light>::emissionAt(const Vertex& vertex, const Event& event) const {
    if (event.solid.mesh) return environment_.emission(solids_.meshEmission(vertex.ray, event.solid));
    const Light emission = environment_.emission(lamps_.emission(event.solid.surface, -vertex.ray.direction));
    if (lamps_.empty() || vertex.place == Place::eye) return emission;
    const double chance = density(vertex, vertex.ray.direction);
    const double aimed = lamps_.density(vertex.ray.origin, event.solid.surface);
    return chance > 0.0 ? emission * (chance / (chance + aimed)) : Light(0.0);
}

/// Light of a chosen lamp that reaches the vertex and goes on along the path.
template <typename Light>
Light BasicPathTracer<Light>::lampLight(const Path& path, Random& random) const {
    const Vertex& vertex = path.vertex;
    const glm::dvec3& point = vertex.ray.origin;
    const std::optional<LampSample> lamp = lamps_.sample(point, random);
    if (!lamp) return Light(0.0);
    const double chance = response(vertex, lamp->direction);
    if (!(chance > 0.0)) return Light(0.0);
    const Ray shadow{point, lamp->direction};
    const std::optional<SolidHit> hit = solids_.nearest(shadow, vertex.solid);
    if (!hit || hit->surface != lamp->surface) return Light(0.0);
    double weight = chance / (density(vertex, lamp->direction) + lamp->density);
    weight = clouds_.passed(vertex.voxels, lamp->direction, random, weight, 0.0, hit->metres);
    Light light =
        weight * environment_.emission(lamps_.emission(lamp->surface, -lamp->direction)) * hue(path, lamp->direction);
    if (!haze_.empty()) light *= haze_.transmittance(shadow, hit->metres);
    return light;
}

/// Light of the sky for a path from `vertex` that escapes there by chance, without the share that `skyLight` covers.
template <typename Light>
Light BasicPathTracer<Light>::skyByChance(const Vertex& vertex) const {
    const glm::dvec3& direction = vertex.ray.direction;
    const Light radiance = environment_.radiance(direction);
    if (!environment_.aimed()) return radiance;
    const double chance = density(vertex, direction);
    return chance > 0.0 ? radiance * (chance / (chance + environment_.density(direction))) : Light(0.0);
}

/// Light of a direction that is drawn from the map of the sky, which reaches the vertex and goes on along the path.
template <typename Light>
Light BasicPathTracer<Light>::skyLight(const Path& path, Random& random) const {
    const Vertex& vertex = path.vertex;
    const SkyMapSample sky = environment_.sample(random);
    const double chance = response(vertex, sky.direction);
    const Ray shadow{vertex.ray.origin, sky.direction};
    if (!(chance > 0.0) || solids_.block(shadow, vertex.solid)) return Light(0.0);
    double weight = chance / (density(vertex, sky.direction) + sky.density);
    weight = clouds_.passed(vertex.voxels, sky.direction, random, weight, 0.0);
    const Light light = weight * environment_.radiance(sky.direction) * hue(path, sky.direction);
    return haze_.empty() ? light : light * haze_.transmittance(shadow, endless);
}

/// Light of the sun's disc for a path from `vertex` that escapes into it by chance, without the share that
/// `sunTransmission` covers.
template <typename Light>
Light BasicPathTracer<Light>::sunByChance(const Vertex& vertex) const {
    const Light disc = environment_.discRadiance(vertex.ray.direction);
    if (glm::compMax(disc) == 0.0) return disc;
    const double expected = density(vertex, vertex.ray.direction) * glm::two_pi<double>() * environment_.sun().cone();
    return disc * (expected / (1.0 + expected));
}

/// Share of the sun's fluence that goes on along the path, 1/sr, by a shadow ray to a point of the disc, without the
/// share that `sunByChance` covers. No path meets a point-like sun by chance, so the shadow ray has all of its light.
template <typename Light>
Light BasicPathTracer<Light>::sunTransmission(const Path& path, double strength, Random& random) const {
    const Vertex& vertex = path.vertex;
    const SunDisc& sun = environment_.sun();
    const glm::dvec3 toSun = sun.sample(random);
    const double expected = density(vertex, toSun) * glm::two_pi<double>() * sun.cone();
    double weight = response(vertex, toSun) * sun.limb(toSun) / (1.0 + expected);
    const double threshold = shadowThreshold / strength;
    if (weight < threshold) {
        if (random.uniform() * threshold >= weight) return Light(0.0);
        weight = threshold;
    }
    const Ray shadow{vertex.ray.origin, toSun};
    if (solids_.block(shadow, vertex.solid)) return Light(0.0);
    weight = clouds_.passed(vertex.voxels, toSun, random, weight, threshold);
    if (weight == 0.0) return Light(0.0);
    const Light light = weight * hue(path, toSun);
    if (haze_.empty()) return light;
    return light * haze_.transmittance(shadow, endless);
}

/// Follows the path to its next event, adds the light there to what it found, and continues. Returns false if the path
/// ends.
template <typename Light>
bool BasicPathTracer<Light>::step(Path& path, Found& found, std::vector<Path>& branches, Random& random) const {
    auto& [vertex, throughput, collisions, scattered] = path;
    const Event event = nextEvent(vertex, throughput, random);
    double share = haze_.empty() ? 1.0 : crossHaze(vertex, event, found.radiance, throughput, random);
    if (event.place == Place::sky) {
        if (vertex.place == Place::eye) {
            found.passed = throughput * environment_.relativeRadiance(vertex.ray.direction);
        } else if (isLit(vertex)) {
            found.radiance += throughput * (skyByChance(vertex) + sunByChance(vertex));
        }
        return false;
    }
    if (vertex.place == Place::eye) found.air = event.place == Place::haze && !haze_.isFog(event.index);
    const bool lampFirst = vertex.place == Place::eye && !event.solid.mesh && event.solid.surface >= solids_.things();
    if (event.place == Place::solid)
        (lampFirst ? found.lamps : found.radiance) += throughput * emissionAt(vertex, event);
    if (scattered++ == scatterings_) return false;
    arrive(vertex, event);
    if (event.place == Place::cloud) ++collisions;
    if (event.place != Place::haze) share = scatter(vertex, throughput);
    if (!(glm::compMax(throughput) > 0.0)) return false;
    if (environment_.sunny() && isLit(vertex)) {
        found.radiance +=
            throughput * environment_.sunFluence() * sunTransmission(path, glm::compMax(throughput) / share, random);
    }
    if (!lamps_.empty()) found.radiance += throughput * lampLight(path, random);
    if (environment_.aimed() && isLit(vertex)) found.radiance += throughput * skyLight(path, random);
    if (aureole_) branch(path, branches, random);
    // absorption ends the path only after the light of the collision itself was added
    return survives(throughput, share, random) && head(path, turn(vertex, random), random);
}

template <typename Light>
PathSample BasicPathTracer<Light>::sampleOf(const Found& found) const {
    const glm::dvec3 radiance = environment_.rgb(found.radiance);
    if (found.air) return {glm::dvec3(0.0), radiance};
    return {radiance, environment_.rgb(found.passed), environment_.rgb(found.lamps)};
}

template <typename Light>
PathSample BasicPathTracer<Light>::trace(const Ray& ray, Random& random) const {
    Found found;
    Path path;
    path.vertex.ray = ray;
    path.vertex.voxels = clouds_.raysOf(ray);
    std::vector<Path> branches;
    const int limit = haze_.hasFog() ? fogCollisionLimit : collisionLimit;
    for (int collisions = 0; collisions < limit; ++collisions) {
        if (step(path, found, branches, random)) continue;
        if (branches.empty()) {
            PathSample sample = sampleOf(found);
            sample.events = collisions + 1;
            return sample;
        }
        path = std::move(branches.back());
        branches.pop_back();
    }
    PathSample sample = sampleOf(found);
    sample.lost = true;
    sample.events = limit;
    return sample;
}

template <typename Light>
glm::dvec3 BasicPathTracer<Light>::discUnit() const {
    if constexpr (std::is_same_v<Haze, Fog>) return environment_.meanDiscRadiance();
    return glm::dvec3(1.0);
}

template <typename Light>
glm::dvec3 BasicPathTracer<Light>::discSeen(const Ray& ray) const {
    const RayIntegrals line = integrate(ray);
    if constexpr (std::is_same_v<Haze, Fog>) {
        return line.transmittance * environment_.sun().limb(ray.direction);
    } else {
        return line.clear *
               environment_.rgb(haze_.transmittance(ray, endless) * environment_.discRadiance(ray.direction));
    }
}

template <typename Light>
glm::dvec3 BasicPathTracer<Light>::lampSeen(const Ray& ray, std::size_t lamp) const {
    const std::optional<SolidHit> hit = solids_.nearest(ray, {});
    if (!hit || hit->surface != solids_.things() + lamp) return glm::dvec3(0.0);
    Light light = environment_.emission(lamps_.emission(hit->surface, -ray.direction));
    if (!haze_.empty()) light *= haze_.transmittance(ray, hit->metres);
    return clouds_.integrate(ray, hit->metres).transmittance * environment_.rgb(light);
}

template class BasicPathTracer<glm::dvec3>;
template class BasicPathTracer<Four>;

}  // namespace lumulus::reference
