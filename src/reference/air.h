#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>

#include "reference/air_medium.h"
#include "reference/air_path.h"
#include "reference/haze_collision.h"
#include "reference/phase.h"
#include "reference/random.h"

namespace lumulus::reference {

/// The air of an atmosphere as a medium that paths collide with. It has the functions of `Fog`, at four wavelengths:
/// free paths are drawn for one of them, chosen by the throughput, from optical depths that are integrated along the
/// ray, and their density is the mean over that choice (Veach 1997, the balance heuristic). So the sum of a
/// throughput's wavelengths never grows.
class Air {
  public:
    /// `ground`: y of the ground at x = z = 0 in metres.
    Air(const AirMedium& medium, double ground);

    bool empty() const { return false; }

    /// Transmittance from the ray's origin to `metres` (infinity is allowed), or to the ground where that is nearer.
    Four transmittance(const Ray& ray, double metres) const;

    /// The first collision of light of this throughput before `limit` metres, if there is one: with a molecule (0) or
    /// with aerosol (1).
    std::optional<HazeCollision> collide(const Ray& ray, double limit, const Four& throughput, Random& random) const;

    /// The throughput of a path that reached `metres` without a collision, as `collide` has drawn it.
    Four passed(const Ray& ray, double metres, const Four& throughput) const;

    /// The throughput after the collision, absorption included.
    Four scattered(const Ray& ray, const HazeCollision& collision, const Four& throughput) const;

    /// Air gives off no light.
    Four emitted(const Ray&, double, const Four&, Random&) const { return Four(0.0); }

    const PhaseFunction& phase(std::size_t medium) const { return phases_[medium]; }

  private:
    Four opticalDepth(const Ray& ray, double metres) const;
    double heightAt(const glm::dvec3& point) const;
    Four scatteringOf(std::size_t part, double height) const;

    AirMedium medium_;
    double ground_;
    std::array<PhaseFunction, 2> phases_;
};

}  // namespace lumulus::reference
