#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "reference/instance_tree.h"
#include "reference/majorant.h"
#include "reference/medium.h"
#include "reference/phase.h"
#include "reference/random.h"
#include "scene/scene.h"

namespace lumulus::reference {

/// Transmittance of the medium along the ray, an unbiased estimate by ratio tracking (Novák et al. 2014): the weight,
/// `weight` at the start, falls at each tentative collision by the share of null ones; below `threshold` Russian
/// roulette lifts it back to the threshold or ends it at 0. Up to `limit` metres.
double ratioTrack(const Medium& medium, const MajorantGrid& majorants, const VoxelRay& ray, Random& random,
                  double weight, double threshold, double limit = std::numeric_limits<double>::infinity());

/// A collision with a particle of a cloud.
struct CloudCollision {
    double metres = 0.0;
    std::size_t cloud = 0;
};

/// A ray among the clouds.
struct CloudRays {
    Ray world;
    std::vector<VoxelRay> voxels;  ///< the ray in the voxel coordinates of each cloud; empty where there are many
};

/// The clouds of a scene, all together, each with its own place, majorants, phase function and albedo; clouds of one
/// volume share its voxels. Where they overlap, their extinctions add up: each is tracked alone, and the nearest
/// collision counts, so that each has its share of σt. A few clouds are asked one by one, many by a tree of their
/// boxes. Clouds without density or extinction are left out.
class Clouds {
  public:
    /// One volume for each cloud of the scene. Errors: InputError for a phase function that is none.
    Clouds(const std::vector<scene::Cloud>& clouds, const std::vector<vdb::PlacedVolume>& volumes, Majorant majorant);

    bool empty() const { return parts_.empty(); }
    const PhaseFunction& phase(std::size_t cloud) const { return phases_[parts_[cloud].phase]; }
    const glm::dvec3& albedo(std::size_t cloud) const { return parts_[cloud].albedo; }

    /// The phase function with the highest value forward, or null where there is no cloud.
    const PhaseFunction* narrowestPhase() const;

    CloudRays raysOf(const Ray& ray) const;
    /// Moves the origin of the rays along them.
    void advance(CloudRays& rays, double metres) const;
    /// Points the rays along a direction of the world.
    void turn(CloudRays& rays, const glm::dvec3& direction) const;

    /// The first collision of all before `limit` metres, by delta tracking (Woodcock 1965).
    std::optional<CloudCollision> collide(const CloudRays& rays, double limit, Random& random) const;

    /// The weight of a shadow ray that leaves the origin of `rays` in a direction of the world: ratioTrack through one
    /// cloud after another.
    double passed(const CloudRays& rays, const glm::dvec3& direction, Random& random, double weight, double threshold,
                  double limit = std::numeric_limits<double>::infinity()) const;

    /// What a ray meets of all of them, without noise.
    LineIntegrals integrate(const Ray& ray, double limit) const;

    /// Metres to the nearest point of the ray where there is a density above 0; absent where there is none.
    std::optional<double> front(const Ray& ray) const;

  private:
    struct Part {
        Medium medium;
        std::size_t majorants;  ///< index into `majorants_`
        std::size_t phase;      ///< index into `phases_`
        glm::dvec3 albedo;
    };

    template <typename Visit>
    void eachMet(const Ray& ray, double limit, Visit&& visit) const;

    std::vector<Part> parts_;
    std::vector<MajorantGrid> majorants_;
    std::vector<PhaseFunction> phases_;
    std::optional<InstanceTree> tree_;  ///< of the parts, where there are many
};

}  // namespace lumulus::reference
