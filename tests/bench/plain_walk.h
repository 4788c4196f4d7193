#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "cloud/asset.h"
#include "light/photon/photon_map.h"
#include "scene/scene.h"
#include "vdb/volume.h"

/// The photon walk as one would write it in plain C++ for this machine, against which the GPU's is measured: the same
/// estimator (delta tracking with local majorants, empty space crossed at once, the peak cut out, the sun's first turn
/// left out, one voxel looked up at a collision) into the same store (bands² coefficients for each of R, G, B in the
/// leaves of the kD-tree). It is free to do what suits a CPU: oneTBB, a fast generator with a state, sums of its own in
/// each thread, no records.
namespace lumulus::bench {

template <class Number>
struct WalkResult {
    std::uint64_t events = 0, nulls = 0, records = 0;
    std::vector<Number> sums;  ///< [collector][RGB][bands²], harmonics times power
    double unit = 1.0;         ///< watts that a sum of 1 stands for
};

class PlainWalk {
  public:
    static constexpr int bands = 6;

    /// All must outlive the walk. At most 65,535 collectors.
    PlainWalk(const vdb::Volume& volume, const cloud::Asset& cloud, const photon::Medium& medium);

    /// Number float: the fastest store, whose last bits depend on which thread walked which photon. std::int64_t: the
    /// GPU's store, integers of the same unit, whose bits do not.
    template <class Number>
    WalkResult<Number> trace(const scene::Sun& sun, const scene::Sky& sky, std::uint64_t photons,
                             std::uint64_t seed) const;

  private:
    struct Lights;
    struct Photon;
    template <class Number>
    struct Sums;
    class Random;

    const photon::Medium& medium_;
    std::size_t collectors_;
    glm::ivec3 size_, cells_;
    glm::vec3 cellSize_;
    glm::mat3 worldToCells_;  ///< cells per metre
    glm::dmat3 faceArea_;
    float extinction_, scatterShare_;  ///< collisions that are turns, or not at albedo below 1
    glm::vec3 straightWeight_;
    std::vector<float> majorants_;               ///< with distances in empty space, as the GPU's
    std::vector<std::uint16_t> density_;         ///< of 65535, half the bytes of floats
    std::vector<std::uint16_t> collectorIndex_;  ///< of each voxel

    float densityNear(const glm::vec3& voxel, Random& random) const;
    Photon emit(const Lights& lights, bool ofSun, Random& random) const;
    template <class Number>
    bool collide(Photon& photon, const glm::vec3& voxel, Random& random, Sums<Number>& sums) const;
    template <class Number>
    void record(const Photon& photon, const glm::vec3& voxel, Sums<Number>& sums) const;
    template <class Number>
    void walk(Photon& photon, Random& random, Sums<Number>& sums) const;
};

}  // namespace lumulus::bench
