#pragma once

#include <cstdint>
#include <glm/glm.hpp>

/// Seeded noise for the procedural clouds. All randomness comes from integer hashes, so that a seed gives the same
/// cloud on every machine.
namespace lumulus::vdb {

/// A 32-bit hash of a grid cell.
std::uint32_t hashCell(const glm::ivec3& cell, std::uint32_t seed);

/// A well mixed 32-bit seed for one use (`stream`) of the user's seed.
std::uint32_t deriveSeed(std::uint64_t seed, std::uint32_t stream);

/// Gradient noise (Perlin 2002) with features of size 1: smooth, mean 0, within about ±1.
float gradientNoise(const glm::vec3& point, std::uint32_t seed);

/// Sum of `octaves` of gradient noise, each of half the size and half the amplitude; within about ±1.
float fractalNoise(const glm::vec3& point, std::uint32_t seed, int octaves);

/// Distance to the nearest of the feature points, one in each unit cell (Worley 1996).
float cellDistance(const glm::vec3& point, std::uint32_t seed);

/// Round bumps between sharp creases like a cauliflower's surface, 0 in a crease to 1 on a bump.
float billowNoise(const glm::vec3& point, std::uint32_t seed);

/// Smooth step from 0 at `low` to 1 at `high` (cubic Hermite).
inline float smoothRamp(float low, float high, float value) {
    const float t = glm::clamp((value - low) / (high - low), 0.0F, 1.0F);
    return t * t * (3.0F - 2.0F * t);
}

/// Random numbers by counter: the n-th draw is a hash of (seed, n).
class RandomStream {
  public:
    explicit RandomStream(std::uint32_t seed) : seed_(seed) {}

    float uniform();                       ///< in [0, 1)
    float uniform(float low, float high);  ///< in [low, high)

  private:
    std::uint32_t seed_;
    int draws_ = 0;
};

}  // namespace lumulus::vdb
