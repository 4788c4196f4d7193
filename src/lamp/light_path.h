#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "lamp/beam.h"
#include "lamp/clouds.h"
#include "lamp/depth_map.h"
#include "lamp/haze.h"
#include "scene/sky.h"

namespace lumulus::lamp {

/// What light of lamps meets. The ground is a plane.
struct Around {
    const Haze& haze;
    const Clouds& clouds;
    const std::optional<scene::Ground>& ground;
    const Solids* solids = nullptr;  ///< null: there is none
};

/// Who sees the events of paths.
struct Eye {
    glm::dvec3 position{0.0};
    const DepthMap& clouds;  ///< before it
    const DepthMap& solids;  ///< the same
    double least = 0.0;      ///< LightPaths::leastDistance() of it
};

/// Paths of light from lamps through fog and clouds, over a ground. Each path is a function of its number.
class LightPaths {
  public:
    /// Direction from the eye, what an event there sends to it [W/m² on a plane that faces it], and whether that is in
    /// a cloud.
    using Seen = std::function<void(const glm::dvec3& towards, const glm::dvec3& share, bool inCloud)>;

    LightPaths(const Around& around, std::span<const Beam> beams, std::uint64_t count, std::uint64_t seed);

    /// Metres from an eye within which events do not grow any more by being nearer to it: a share of the mean free path
    /// there, or of the way to the nearest lamp where the air is so clear that it is shorter.
    double leastDistance(const glm::dvec3& eye) const;

    /// Follows a path, and tells of its events from the second on as `eye` sees them.
    void trace(std::uint64_t path, const Eye& eye, const Seen& seen) const;

  private:
    struct Walk;
    bool start(Walk& walk, std::uint64_t path) const;
    bool step(Walk& walk) const;
    bool goTo(Walk& walk, double metres, const glm::dvec3& albedo, const glm::dvec3& chances) const;
    bool meetSolid(Walk& walk, const SolidMeeting& solid, const glm::dvec3& chances) const;
    bool hidden(const Walk& walk, const Eye& eye, const glm::dvec3& way, double distance) const;
    bool meetGround(Walk& walk, double metres, const glm::dvec3& chances) const;
    std::optional<Meeting> meetCloud(Walk& walk, double limit) const;
    glm::dvec3 response(const Walk& walk, const glm::dvec3& direction) const;
    void show(const Walk& walk, const Eye& eye, const Seen& seen) const;
    void turn(Walk& walk) const;

    const Haze& haze_;
    const Clouds& clouds_;
    std::optional<scene::Ground> ground_;
    const Solids* solids_;
    std::span<const Beam> beams_;
    std::uint64_t count_, seed_;
    std::vector<double> upTo_;  ///< share of the power in this lamp and those before
};

}  // namespace lumulus::lamp
