#include "reference/clouds.h"

#include <algorithm>
#include <cassert>
#include <map>
#include <memory>
#include <utility>

namespace lumulus::reference {
namespace {

/// Clouds up to this number are asked one by one, which costs them no change of coordinates at each event.
constexpr std::size_t few = 4;

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
    std::map<const vdb::Volume*, std::shared_ptr<const DensityField>> fields;
    std::map<std::pair<const vdb::Volume*, double>, std::size_t> grids;
    std::vector<scene::Phase> phases;
    for (std::size_t i = 0; i < volumes.size(); ++i) {
        const scene::Cloud& cloud = clouds[i];
        const double extinction = cloud.extinction * cloud.densityScale;
        std::shared_ptr<const DensityField>& field = fields[volumes[i].volume];
        if (!field) field = std::make_shared<const DensityField>(*volumes[i].volume);
        Medium medium(field, volumes[i].toWorld, extinction);
        if (medium.maximumDensity() * medium.extinctionScale() <= 0.0) continue;
        const auto [grid, isNew] = grids.try_emplace({volumes[i].volume, extinction}, majorants_.size());
        if (isNew) majorants_.emplace_back(medium, majorant);
        const auto phase = std::ranges::find(phases, cloud.phase);
        const auto phaseIndex = static_cast<std::size_t>(phase - phases.begin());
        if (phase == phases.end()) {
            phases.push_back(cloud.phase);
            phases_.emplace_back(cloud.phase);
        }
        parts_.push_back({std::move(medium), grid->second, phaseIndex, cloud.albedo});
    }
    if (parts_.size() <= few) return;
    std::vector<Box> boxes;
    for (const Part& part : parts_) boxes.push_back(part.medium.box());
    tree_.emplace(boxes);
}

/// Calls `visit(cloud)` for those that the ray may meet before `limit` metres, in any order; it returns the limit from
/// there on.
template <typename Visit>
void Clouds::eachMet(const Ray& ray, double limit, Visit&& visit) const {
    if (tree_) return tree_->visit(ray, limit, visit);
    for (std::size_t i = 0; i < parts_.size(); ++i) visit(i);
}

const PhaseFunction* Clouds::narrowestPhase() const {
    const auto narrowest = std::ranges::max_element(phases_, {}, [](const auto& phase) { return phase.peak(); });
    return narrowest == phases_.end() ? nullptr : &*narrowest;
}

CloudRays Clouds::raysOf(const Ray& ray) const {
    CloudRays rays{ray, {}};
    if (tree_) return rays;
    rays.voxels.reserve(parts_.size());
    for (const Part& part : parts_) rays.voxels.push_back(part.medium.toVoxel(ray));
    return rays;
}

void Clouds::advance(CloudRays& rays, double metres) const {
    rays.world.origin += metres * rays.world.direction;
    for (VoxelRay& ray : rays.voxels) ray.origin = ray.at(metres);
}

void Clouds::turn(CloudRays& rays, const glm::dvec3& direction) const {
    rays.world.direction = direction;
    for (std::size_t i = 0; i < rays.voxels.size(); ++i) rays.voxels[i].step = parts_[i].medium.stepOf(direction);
}

std::optional<CloudCollision> Clouds::collide(const CloudRays& rays, double limit, Random& random) const {
    std::optional<CloudCollision> nearest;
    eachMet(rays.world, limit, [&](std::size_t i) {
        const Medium& medium = parts_[i].medium;
        const VoxelRay ray = tree_ ? medium.toVoxel(rays.world) : rays.voxels[i];
        const auto metres = collisionIn(medium, majorants_[parts_[i].majorants], ray, limit, random);
        if (metres) {
            nearest = {*metres, i};
            limit = *metres;
        }
        return limit;
    });
    return nearest;
}

double Clouds::passed(const CloudRays& rays, const glm::dvec3& direction, Random& random, double weight,
                      double threshold, double limit) const {
    eachMet({rays.world.origin, direction}, limit, [&](std::size_t i) {
        if (!(weight > 0.0)) return 0.0;
        const Medium& medium = parts_[i].medium;
        const glm::dvec3 origin = tree_ ? medium.toVoxel(rays.world.origin) : rays.voxels[i].origin;
        weight = ratioTrack(medium, majorants_[parts_[i].majorants], {origin, medium.stepOf(direction)}, random, weight,
                            threshold, limit);
        return limit;
    });
    return weight;
}

LineIntegrals Clouds::integrate(const Ray& ray, double limit) const {
    std::vector<std::vector<OpticalPiece>> pieces;
    eachMet(ray, limit, [&](std::size_t i) {
        const Medium& medium = parts_[i].medium;
        pieces.push_back(opticalPieces(medium, medium.toVoxel(ray), limit));
        if (pieces.back().empty()) pieces.pop_back();
        return limit;
    });
    return integrateAlong(pieces);
}

std::optional<double> Clouds::front(const Ray& ray) const {
    std::optional<double> nearest;
    constexpr double endless = std::numeric_limits<double>::infinity();
    eachMet(ray, endless, [&](std::size_t i) {
        const Medium& medium = parts_[i].medium;
        const std::optional<double> metres = frontAlong(medium, medium.toVoxel(ray));
        if (metres && !(nearest && *nearest <= *metres)) nearest = metres;
        return nearest.value_or(endless);
    });
    return nearest;
}

}  // namespace lumulus::reference
