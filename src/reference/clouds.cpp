#include "reference/clouds.h"

#include <algorithm>
#include <cassert>

namespace lumulus::reference {
namespace {

/// The part of the ray within the medium's box and before `limit` metres.
std::optional<Interval> clipped(const Medium& medium, const VoxelRay& ray, double limit) {
    std::optional<Interval> inside = medium.clip(ray);
    if (!inside || !(inside->begin < limit)) return std::nullopt;
    inside->end = std::min(inside->end, limit);
    return inside;
}

/// Metres to the first collision with one medium before `limit`.
std::optional<double> collisionIn(const Medium& medium, const MajorantGrid& majorants, const VoxelRay& ray,
                                  double limit, Random& random) {
    const std::optional<Interval> inside = clipped(medium, ray, limit);
    if (!inside) return std::nullopt;
    bool collided = false;
    double metres = 0.0;
    majorants.walk(ray, *inside, random, [&](double t, double majorant) {
        const double extinction = medium.extinctionScale() * medium.density(ray.at(t));
        collided = random.uniform() * majorant < extinction;
        metres = t;
        return collided;
    });
    return collided ? std::optional(metres) : std::nullopt;
}

}  // namespace

double ratioTrack(const Medium& medium, const MajorantGrid& majorants, const VoxelRay& ray, Random& random,
                  double weight, double threshold, double limit) {
    const std::optional<Interval> inside = clipped(medium, ray, limit);
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

Clouds::Clouds(const std::vector<scene::Cloud>& clouds, const std::vector<vdb::PlacedVolume>& volumes,
               Majorant majorant) {
    assert(clouds.size() == volumes.size());
    for (std::size_t i = 0; i < volumes.size(); ++i) {
        const scene::Cloud& cloud = clouds[i];
        Medium medium(volumes[i], cloud.extinction * cloud.densityScale);
        if (medium.maximumDensity() * medium.extinctionScale() <= 0.0) continue;
        const MajorantGrid majorants(medium, majorant);
        parts_.push_back({std::move(medium), majorants, PhaseFunction(cloud.phase), cloud.albedo});
    }
}

const PhaseFunction* Clouds::narrowestPhase() const {
    const auto narrowest =
        std::ranges::max_element(parts_, {}, [](const Part& part) { return part.phase.evaluate(0.0); });
    return narrowest == parts_.end() ? nullptr : &narrowest->phase;
}

CloudRays Clouds::raysOf(const Ray& ray) const {
    CloudRays rays;
    rays.reserve(parts_.size());
    for (const Part& part : parts_) rays.push_back(part.medium.toVoxel(ray));
    return rays;
}

void Clouds::advance(CloudRays& rays, double metres) const {
    for (VoxelRay& ray : rays) ray.origin = ray.at(metres);
}

void Clouds::turn(CloudRays& rays, const glm::dvec3& direction) const {
    for (std::size_t i = 0; i < parts_.size(); ++i) rays[i].step = parts_[i].medium.stepOf(direction);
}

std::optional<CloudCollision> Clouds::collide(const CloudRays& rays, double limit, Random& random) const {
    std::optional<CloudCollision> nearest;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        const auto metres = collisionIn(parts_[i].medium, parts_[i].majorants, rays[i], limit, random);
        if (!metres) continue;
        nearest = {*metres, i};
        limit = *metres;
    }
    return nearest;
}

double Clouds::passed(const CloudRays& rays, const glm::dvec3& direction, Random& random, double weight,
                      double threshold, double limit) const {
    for (std::size_t i = 0; i < parts_.size() && weight > 0.0; ++i) {
        const VoxelRay ray{rays[i].origin, parts_[i].medium.stepOf(direction)};
        weight = ratioTrack(parts_[i].medium, parts_[i].majorants, ray, random, weight, threshold, limit);
    }
    return weight;
}

LineIntegrals Clouds::integrate(const Ray& ray, double limit) const {
    std::vector<std::vector<OpticalPiece>> pieces;
    for (const Part& part : parts_) pieces.push_back(opticalPieces(part.medium, part.medium.toVoxel(ray), limit));
    return integrateAlong(pieces);
}

std::optional<double> Clouds::front(const Ray& ray) const {
    std::optional<double> nearest;
    for (const Part& part : parts_) {
        const std::optional<double> metres = frontAlong(part.medium, part.medium.toVoxel(ray));
        if (metres && !(nearest && *nearest <= *metres)) nearest = metres;
    }
    return nearest;
}

}  // namespace lumulus::reference
