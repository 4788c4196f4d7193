#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "lamp/beam.h"
#include "lamp/haze.h"
#include "scene/sky.h"

namespace lumulus::lamp {

/// Paths of light from lamps through fog, over a ground that is a plane. Each path is a function of its number.
class LightPaths {
  public:
    /// Direction from the eye, and what an event there sends to it [W/m² on a plane that faces it].
    using Seen = std::function<void(const glm::dvec3& towards, const glm::dvec3& share)>;

    LightPaths(const Haze& haze, std::span<const Beam> beams, const std::optional<scene::Ground>& ground,
               std::uint64_t count, std::uint64_t seed);

    /// Follows a path, and tells of its events from the second on as `eye` sees them.
    void trace(std::uint64_t path, const glm::dvec3& eye, const Seen& seen) const;

  private:
    struct Walk;
    bool start(Walk& walk, std::uint64_t path) const;
    bool step(Walk& walk) const;
    bool meetGround(Walk& walk, double metres, const glm::dvec3& chances) const;
    void show(const Walk& walk, const glm::dvec3& eye, const Seen& seen) const;
    void turn(Walk& walk) const;

    const Haze& haze_;
    std::span<const Beam> beams_;
    std::optional<scene::Ground> ground_;
    std::uint64_t count_, seed_;
    std::vector<double> upTo_;  ///< share of the power in this lamp and those before
};

}  // namespace lumulus::lamp
