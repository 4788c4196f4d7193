#include "reference/tracer.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace lumulus::reference {
namespace {

/// A path that scatters more often is counted as lost: far beyond what any sane scene needs.
constexpr int collisionLimit = 100'000'000;

/// [1/sr] Below this product of throughput, phase function and transmittance a shadow ray plays Russian roulette: most
/// light of a forward lobe comes with few of them. Best on the Disney cloud between .02 and .1.
constexpr double shadowThreshold = 0.05;

double largest(const glm::dvec3& v) {
    return std::max({v.x, v.y, v.z});
}

}  // namespace

double ratioTrack(const Medium& medium, const MajorantGrid& majorants, const VoxelRay& ray, Random& random,
                  double weight, double threshold) {
    const std::optional<Interval> inside = medium.clip(ray);
    if (!inside) return weight;
    majorants.walk(ray, *inside, random, [&](double t, double majorant) {
        weight *= std::max(0.0, 1.0 - medium.extinctionScale() * medium.density(ray.at(t)) / majorant);
        if (weight < threshold) {
            weight = random.uniform() * threshold < weight ? threshold : 0.0;
        }
        return weight == 0.0;
    });
    return weight;
}

PathTracer::PathTracer(const scene::Scene& scene, const vdb::Volume* volume, Majorant majorant)
    : sky_(scene.sky.radiance), sunDirection_(glm::normalize(scene.sun.directionTo)) {
    const double radius = 0.5 * glm::radians(scene.sun.angularDiameter);
    sunCone_ = 2.0 * std::sin(0.5 * radius) * std::sin(0.5 * radius);
    // irradiance counts the disc's points by the cosine to its middle: E = L π sin²; the fluence does not: L 2π(1 −
    // cos)
    sunFluence_ = scene.sun.irradiance * (2.0 / (2.0 - sunCone_));
    if (radius > 0.0) sunRadiance_ = scene.sun.irradiance / (glm::pi<double>() * std::sin(radius) * std::sin(radius));
    sunny_ = largest(sunFluence_) > 0.0;
    if (volume == nullptr || scene.clouds.empty()) return;
    const scene::Cloud& cloud = scene.clouds.front();
    const Medium medium(*volume, cloud.extinction * cloud.densityScale);
    if (medium.maximumDensity() * medium.extinctionScale() <= 0.0) return;
    cloud_.emplace(Cloud{medium, MajorantGrid(medium, majorant), PhaseFunction(cloud.phase), cloud.albedo});
}

bool PathTracer::scatter(glm::dvec3& throughput, Random& random) const {
    throughput *= cloud_->albedo;
    const double survival = largest(cloud_->albedo);
    if (survival < 1.0) {
        if (random.uniform() >= survival) return false;
        throughput /= survival;
    }
    return largest(throughput) > 0.0;
}

double PathTracer::sunTransmission(const glm::dvec3& point, const glm::dvec3& direction, double strength,
                                   Random& random) const {
    const double oneMinusCos = sunCone_ * random.uniform();
    const glm::dvec3 toSun = sunCone_ > 0.0 ? turned(sunDirection_, oneMinusCos, random) : sunDirection_;
    double weight = cloud_->phase.evaluate(oneMinusCosBetween(direction, toSun));
    const double threshold = shadowThreshold / strength;
    if (weight < threshold) {
        if (random.uniform() * threshold >= weight) return 0.0;
        weight = threshold;
    }
    const VoxelRay shadow{point, cloud_->medium.stepOf(toSun)};
    return ratioTrack(cloud_->medium, cloud_->majorants, shadow, random, weight, threshold);
}

PathSample PathTracer::trace(const Ray& ray, Random& random) const {
    PathSample sample;
    sample.passed = true;
    if (!cloud_) return sample;
    glm::dvec3 direction = ray.direction;
    glm::dvec3 throughput(1.0);
    VoxelRay path = cloud_->medium.toVoxel(ray);
    for (int collisions = 0; collisions < collisionLimit; ++collisions) {
        const std::optional<Interval> inside = cloud_->medium.clip(path);
        bool collided = false;
        if (inside) {
            cloud_->majorants.walk(path, *inside, random, [&](double t, double majorant) {
                const glm::dvec3 point = path.at(t);
                const double extinction = cloud_->medium.extinctionScale() * cloud_->medium.density(point);
                collided = random.uniform() * majorant < extinction;
                if (collided) path.origin = point;
                return collided;
            });
        }
        if (!collided) {
            if (!sample.passed) sample.radiance += throughput * sky_;
            return sample;
        }
        sample.passed = false;
        if (!scatter(throughput, random)) return sample;
        if (sunny_) {
            sample.radiance +=
                throughput * sunFluence_ * sunTransmission(path.origin, direction, largest(throughput), random);
        }
        direction = turned(direction, cloud_->phase.sample(random), random);
        path.step = cloud_->medium.stepOf(direction);
    }
    sample.lost = true;
    return sample;
}

LineIntegrals PathTracer::integrate(const Ray& ray) const {
    return cloud_ ? integrateAlong(cloud_->medium, cloud_->medium.toVoxel(ray)) : LineIntegrals{};
}

std::optional<double> PathTracer::front(const Ray& ray) const {
    return cloud_ ? frontAlong(cloud_->medium, cloud_->medium.toVoxel(ray)) : std::nullopt;
}

glm::dvec3 PathTracer::discRadiance(const glm::dvec3& direction) const {
    return oneMinusCosBetween(direction, sunDirection_) < sunCone_ ? sunRadiance_ : glm::dvec3(0.0);
}

}  // namespace lumulus::reference
