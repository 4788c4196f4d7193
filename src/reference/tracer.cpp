#include "reference/tracer.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtx/component_wise.hpp>
#include <limits>

namespace lumulus::reference {
namespace {

/// Collisions after which a path counts as lost, far more than any sane scene needs.
constexpr int collisionLimit = 100'000'000;

/// Collisions in fog after which a path counts as lost. Fog may reach to the sky and absorb nothing. The lost light is
/// a share of some 1e-3 where visibility is a hundredth of the distance to the sky, and more in denser fog.
constexpr int fogCollisionLimit = 100'000;

/// Product of throughput, phase function and transmittance [1/sr] below which a shadow ray plays Russian roulette: few
/// rays carry most of the light of a forward lobe. Values between 0.02 and 0.1 are best in the Disney cloud.
constexpr double shadowThreshold = 0.05;

/// Russian roulette with this chance of going on; false where the path ends.
bool survives(glm::dvec3& throughput, double chance, Random& random) {
    if (chance < 1.0) {
        if (random.uniform() >= chance) return false;
        throughput /= chance;
    }
    return true;
}

}  // namespace

PathTracer::PathTracer(const scene::Scene& scene, const std::vector<vdb::PlacedVolume>& volumes, Majorant majorant,
                       const glm::dvec3& eye)
    : environment_(scene.sky, scene.sun),
      clouds_(scene.clouds, volumes, majorant),
      fog_(scene.fog, eye),
      surfaces_(scene.surfaces),
      lamps_(scene.surfaces),
      inscattering_(scene.fog.inscattering) {
    const PhaseFunction* phase = clouds_.narrowestPhase();
    if (environment_.sunny() && phase != nullptr)
        aureole_ = Aureole::of(*phase, environment_.sunDirection(), environment_.sunRadius());
}

PathTracer::Event PathTracer::nextEvent(const Vertex& vertex, const glm::dvec3& throughput, Random& random) const {
    Event event;
    if (!surfaces_.empty()) {
        const auto hit = surfaces_.nearest(vertex.ray, vertex.surface());
        if (hit) event = {Place::surface, hit->metres, hit->surface};
    }
    if (!fog_.empty()) {
        if (const auto collision = fog_.collide(vertex.ray, event.metres, throughput, random)) {
            event = {Place::fog, collision->metres, collision->medium};
        }
    }
    if (const auto collision = clouds_.collide(vertex.voxels, event.metres, random)) {
        event = {Place::cloud, collision->metres, collision->cloud};
    }
    return event;
}

void PathTracer::arrive(Vertex& vertex, const Event& event) const {
    vertex.place = event.place;
    vertex.index = event.index;
    vertex.arrived = vertex.ray.direction;
    vertex.ray.origin += event.metres * vertex.ray.direction;
    clouds_.advance(vertex.voxels, event.metres);
    if (event.place == Place::surface) {
        vertex.normal = surfaces_.normalAgainst(vertex.ray.direction, vertex.ray.origin, event.index);
    }
}

/// Follows the path through the fog to the event: adds emission and updates the throughput (after a collision with fog,
/// to the scattered part). Returns the share of the light that a collision leaves, 1 without a collision.
double PathTracer::crossFog(const Vertex& vertex, const Event& event, glm::dvec3& radiance, glm::dvec3& throughput,
                            Random& random) const {
    radiance += fog_.emitted(vertex.ray, event.metres, throughput, random);
    if (event.place != Place::fog) {
        throughput = fog_.passed(vertex.ray, event.metres, throughput);
        return 1.0;
    }
    const glm::dvec3 scattered = fog_.scattered(vertex.ray, {event.metres, event.index}, throughput);
    const double share = (scattered.x + scattered.y + scattered.z) / (throughput.x + throughput.y + throughput.z);
    throughput = scattered;
    return share;
}

/// Updates the throughput after a collision with cloud or surface. Returns the remaining share of the brightest
/// channel.
double PathTracer::scatter(const Vertex& vertex, glm::dvec3& throughput) const {
    const bool atSurface = vertex.place == Place::surface;
    const glm::dvec3& albedo = atSurface ? surfaces_[vertex.index].albedo : clouds_.albedo(vertex.index);
    throughput *= albedo;
    return glm::compMax(albedo);
}

/// Of the cloud or the fog that the path has met.
const PhaseFunction& PathTracer::phaseAt(const Vertex& vertex) const {
    return vertex.place == Place::fog ? fog_.phase(vertex.index) : clouds_.phase(vertex.index);
}

/// Draws the next direction of the path from the phase function, or from the cosine of a diffuse surface.
glm::dvec3 PathTracer::turn(const Vertex& vertex, Random& random) const {
    if (vertex.place == Place::surface) return turned(vertex.normal, 1.0 - std::sqrt(random.uniform()), random);
    return turned(vertex.arrived, phaseAt(vertex).sample(random), random);
}

/// Share of light from `toLight` that goes on along the path, 1/sr: the phase function, or the cosine over π. It is
/// also the density with which the function above draws that direction.
double PathTracer::response(const Vertex& vertex, const glm::dvec3& toLight) const {
    if (vertex.place == Place::surface) {
        return std::max(0.0, glm::dot(vertex.normal, toLight)) * glm::one_over_pi<double>();
    }
    return phaseAt(vertex).evaluate(oneMinusCosBetween(vertex.arrived, toLight));
}

/// What the phase function of droplets makes of the colours of light from a direction. Later scattering events by the
/// mean of the colours: many of them would multiply to weights without bounds, and their colours have blurred by then.
glm::dvec3 PathTracer::hue(const Path& path, const glm::dvec3& toLight) const {
    constexpr int most = 6;
    const Vertex& vertex = path.vertex;
    if (vertex.place != Place::cloud || path.collisions > most) return glm::dvec3(1.0);
    return clouds_.phase(vertex.index).hue(oneMinusCosBetween(vertex.arrived, toLight));
}

/// Density of paths that leave the vertex in a direction, 1/sr: by chance, and as branches to the aureole.
double PathTracer::density(const Vertex& vertex, const glm::dvec3& direction) const {
    return response(vertex, direction) + (aureole_ ? aureole_->density(direction) : 0.0);
}

/// Continues the path in a direction that was drawn by chance or as a branch. Both kinds share the scattered light by
/// the balance heuristic, so that weights never grow. Where more paths go than light is expected from, Russian roulette
/// thins them out to weights of one over the importance. Returns false if the path ends.
bool PathTracer::head(Path& path, const glm::dvec3& direction, Random& random) const {
    Vertex& vertex = path.vertex;
    path.throughput *= hue(path, direction);
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
void PathTracer::branch(const Path& path, std::vector<Path>& branches, Random& random) const {
    Path other = path;
    if (head(other, aureole_->sample(random), random)) branches.push_back(std::move(other));
}

/// Emission of a surface that a path from `vertex` meets by chance, without the share that `lampLight` covers.
glm::dvec3 PathTracer::emissionAt(const Vertex& vertex, const Event& event) const {
    const glm::dvec3& emission = surfaces_[event.index].emission;
    if (lamps_.empty() || vertex.place == Place::eye) return emission;
    const double chance = density(vertex, vertex.ray.direction);
    const double aimed = lamps_.density(vertex.ray.origin, event.index);
    return chance > 0.0 ? emission * (chance / (chance + aimed)) : glm::dvec3(0.0);
}

/// Light of a chosen lamp that reaches the vertex and goes on along the path.
glm::dvec3 PathTracer::lampLight(const Path& path, Random& random) const {
    const Vertex& vertex = path.vertex;
    const glm::dvec3& point = vertex.ray.origin;
    const std::optional<LampSample> lamp = lamps_.sample(point, random);
    if (!lamp) return glm::dvec3(0.0);
    const double chance = response(vertex, lamp->direction);
    if (!(chance > 0.0)) return glm::dvec3(0.0);
    const Ray shadow{point, lamp->direction};
    const std::optional<SurfaceHit> hit = surfaces_.nearest(shadow, vertex.surface());
    if (!hit || hit->surface != lamp->surface) return glm::dvec3(0.0);
    double weight = chance / (density(vertex, lamp->direction) + lamp->density);
    weight = clouds_.passed(vertex.voxels, lamp->direction, random, weight, 0.0, hit->metres);
    glm::dvec3 light = weight * surfaces_[lamp->surface].emission * hue(path, lamp->direction);
    if (!fog_.empty()) light *= fog_.transmittance(shadow, hit->metres);
    return light;
}

/// Light of the sun's disc for a path from `vertex` that escapes into it by chance, without the share that
/// `sunTransmission` covers.
glm::dvec3 PathTracer::sunByChance(const Vertex& vertex) const {
    const glm::dvec3 disc = environment_.discRadiance(vertex.ray.origin, vertex.ray.direction);
    if (glm::compMax(disc) == 0.0) return disc;
    const double expected = density(vertex, vertex.ray.direction) * glm::two_pi<double>() * environment_.sunCone();
    return disc * (expected / (1.0 + expected));
}

/// Share of the sun's fluence that goes on along the path, 1/sr, by a shadow ray to a point of the disc, without the
/// share that `sunByChance` covers. No path meets a point-like sun by chance, so the shadow ray has all of its light.
glm::dvec3 PathTracer::sunTransmission(const Path& path, double strength, Random& random) const {
    const Vertex& vertex = path.vertex;
    const glm::dvec3 toSun = environment_.sampleSun(random);
    const double expected = density(vertex, toSun) * glm::two_pi<double>() * environment_.sunCone();
    double weight = response(vertex, toSun) / (1.0 + expected);
    const double threshold = shadowThreshold / strength;
    if (weight < threshold) {
        if (random.uniform() * threshold >= weight) return glm::dvec3(0.0);
        weight = threshold;
    }
    const Ray shadow{vertex.ray.origin, toSun};
    if (surfaces_.block(shadow, vertex.surface())) return glm::dvec3(0.0);
    weight = clouds_.passed(vertex.voxels, toSun, random, weight, threshold);
    const glm::dvec3 light = weight * environment_.sunTransmittance(vertex.ray.origin) * hue(path, toSun);
    if (fog_.empty()) return light;
    return light * fog_.transmittance(shadow, std::numeric_limits<double>::infinity());
}

/// Follows the path to its next event, adds the light there to the sample, and continues. Returns false if the path
/// ends.
bool PathTracer::step(Path& path, PathSample& sample, std::vector<Path>& branches, Random& random) const {
    auto& [vertex, throughput, collisions] = path;
    const Event event = nextEvent(vertex, throughput, random);
    double share = fog_.empty() ? 1.0 : crossFog(vertex, event, sample.radiance, throughput, random);
    if (event.place == Place::sky) {
        if (vertex.place == Place::eye) {
            sample.passed = throughput * environment_.relativeRadiance(vertex.ray.direction);
        } else if (isLit(vertex)) {
            sample.radiance += throughput * (environment_.radiance(vertex.ray.direction) + sunByChance(vertex));
        }
        return false;
    }
    if (event.place == Place::surface) sample.radiance += throughput * emissionAt(vertex, event);
    arrive(vertex, event);
    if (event.place == Place::cloud) ++collisions;
    if (event.place != Place::fog) share = scatter(vertex, throughput);
    if (!(glm::compMax(throughput) > 0.0)) return false;
    if (environment_.sunny() && isLit(vertex)) {
        sample.radiance +=
            throughput * environment_.sunFluence() * sunTransmission(path, glm::compMax(throughput) / share, random);
    }
    if (!lamps_.empty()) sample.radiance += throughput * lampLight(path, random);
    if (aureole_) branch(path, branches, random);
    // absorption ends the path only after the light of the collision itself was added
    return survives(throughput, share, random) && head(path, turn(vertex, random), random);
}

PathSample PathTracer::trace(const Ray& ray, Random& random) const {
    PathSample sample;
    Path path;
    path.vertex.ray = ray;
    path.vertex.voxels = clouds_.raysOf(ray);
    std::vector<Path> branches;
    const int limit = fog_.empty() ? collisionLimit : fogCollisionLimit;
    for (int collisions = 0; collisions < limit; ++collisions) {
        if (step(path, sample, branches, random)) continue;
        if (branches.empty()) return sample;
        path = std::move(branches.back());
        branches.pop_back();
    }
    sample.lost = true;
    return sample;
}

RayIntegrals PathTracer::integrate(const Ray& ray) const {
    constexpr double endless = std::numeric_limits<double>::infinity();
    RayIntegrals result;
    const auto hit = surfaces_.nearest(ray, Surfaces::none);
    const LineIntegrals line = clouds_.integrate(ray, hit ? hit->metres : endless);
    result.clear = line.transmittance;
    result.distance = line.distance;
    if (hit) {
        result.distance += result.clear * hit->metres;
        result.clear = 0.0;
    }
    result.transmittance = glm::dvec3(result.clear);
    if (!fog_.empty()) result.transmittance *= fog_.transmittance(ray, endless);
    return result;
}

std::optional<double> PathTracer::front(const Ray& ray) const {
    const std::optional<double> metres = clouds_.front(ray);
    const auto hit = surfaces_.nearest(ray, Surfaces::none);
    return hit && !(metres && *metres < hit->metres) ? hit->metres : metres;
}

}  // namespace lumulus::reference
