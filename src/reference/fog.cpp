#include "reference/fog.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "reference/fog_density.h"

namespace lumulus::reference {
namespace {

double sumOf(const glm::dvec3& v) {
    return v.x + v.y + v.z;
}

PhaseFunction phaseOf(const scene::FogMedium& medium) {
    scene::Phase phase;
    phase.model = scene::PhaseModel::henyeyGreenstein;
    phase.g = medium.g;
    return PhaseFunction(phase);
}

/// A channel with the probability of its share in the throughput.
int channelOf(const glm::dvec3& throughput, Random& random) {
    const double at = random.uniform() * sumOf(throughput);
    if (at < throughput.x) return 0;
    return at < throughput.x + throughput.y || throughput.z == 0.0 ? 1 : 2;
}

}  // namespace

Fog::Fog(const scene::Fog& fog, const glm::dvec3& eye) : eye_(eye), skyDistance_(fog.skyDistance) {
    for (const scene::FogMedium& medium : fog.media) {
        media_.push_back({medium, medium.scattering + medium.absorption, phaseOf(medium)});
    }
}

/// The part of the ray within the ball around the eye that the fog fills.
Interval Fog::reach(const Ray& ray) const {
    const glm::dvec3 toEye = eye_ - ray.origin;
    const double closest = glm::dot(toEye, ray.direction);
    const double distance = glm::length(glm::cross(toEye, ray.direction));
    if (!(distance < skyDistance_)) return {};
    const double half = std::sqrt((skyDistance_ - distance) * (skyDistance_ + distance));
    return {std::max(0.0, closest - half), std::max(0.0, closest + half)};
}

glm::dvec3 Fog::opticalDepth(const Ray& ray, double metres) const {
    const Interval part = reach(ray);
    glm::dvec3 depth(0.0);
    for (const Part& m : media_) depth += m.extinction * FogDensity(m.medium, ray, part).pathTo(metres);
    return depth;
}

glm::dvec3 Fog::transmittance(const Ray& ray, double metres) const {
    return glm::exp(-opticalDepth(ray, metres));
}

std::optional<HazeCollision> Fog::collide(const Ray& ray, double limit, const glm::dvec3& throughput,
                                          Random& random) const {
    const Interval part = reach(ray);
    const int channel = channelOf(throughput, random);
    HazeCollision first{limit, media_.size()};
    for (std::size_t i = 0; i < media_.size(); ++i) {
        const double extinction = media_[i].extinction[channel];
        if (!(extinction > 0.0)) continue;
        const double metres = FogDensity(media_[i].medium, ray, part).metresTo(random.exponential() / extinction);
        if (metres < first.metres) first = {metres, i};
    }
    if (first.medium == media_.size()) return std::nullopt;
    return first;
}

/// Transmittance over that of the clearest channel that has light, so that it does not underflow; 0 where there is no
/// light.
glm::dvec3 Fog::relativeTransmittance(const Ray& ray, double metres, const glm::dvec3& throughput) const {
    const glm::dvec3 depth = opticalDepth(ray, metres);
    double least = std::numeric_limits<double>::infinity();
    for (int c = 0; c < 3; ++c) {
        if (throughput[c] > 0.0) least = std::min(least, depth[c]);
    }
    glm::dvec3 result(0.0);
    for (int c = 0; c < 3; ++c) {
        if (throughput[c] > 0.0) result[c] = std::exp(least - depth[c]);
    }
    return result;
}

glm::dvec3 Fog::passed(const Ray& ray, double metres, const glm::dvec3& throughput) const {
    const glm::dvec3 left = throughput * relativeTransmittance(ray, metres, throughput);
    return left * (sumOf(throughput) / sumOf(left));
}

glm::dvec3 Fog::scattered(const Ray& ray, const HazeCollision& collision, const glm::dvec3& throughput) const {
    const Part& m = media_[collision.medium];
    const glm::dvec3 left = throughput * relativeTransmittance(ray, collision.metres, throughput);
    return left * m.medium.scattering * (sumOf(throughput) / sumOf(left * m.extinction));
}

glm::dvec3 Fog::emitted(const Ray& ray, double metres, const glm::dvec3& throughput, Random& random) const {
    glm::dvec3 radiance(0.0);
    for (const Part& m : media_) {
        if (m.medium.emission == glm::dvec3(0.0)) continue;
        const FogDensity density(m.medium, ray, reach(ray));
        const double path = density.pathTo(metres);
        if (!(path > 0.0)) continue;
        // a point drawn by the density; the end of the path has the mean transmittance to it already
        const double point = std::min(metres, density.metresTo(path * random.uniform()));
        radiance += m.medium.emission * path * passed(ray, point, throughput);
    }
    return radiance;
}

}  // namespace lumulus::reference
