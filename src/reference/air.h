#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>

#include "reference/air_medium.h"
#include "reference/air_path.h"
#include "reference/fog_media.h"
#include "reference/haze_collision.h"
#include "reference/phase.h"
#include "reference/random.h"

namespace lumulus::reference {

/// The air of an atmosphere, with the fog in it, as media that paths collide with. It has the functions of `Fog`, at
/// four wavelengths: free paths are drawn for one of them, chosen by the throughput, from optical depths that are
/// integrated along the ray, and their density is the mean over that choice (Veach 1997, the balance heuristic). So the
/// sum of a throughput's wavelengths never grows.
class Air {
  public:
    /// `ground`: y of the ground in metres at the point above the planet's centre, whose x and z are `foot`. Layers of
    /// `fog` are shells above it; a planet with fog has its foot at the origin.
    Air(const AirMedium& medium, double ground, const FogMedia<Four>& fog = {}, const glm::dvec2& foot = {});

    bool empty() const { return false; }
    bool hasFog() const { return !fog_.empty(); }

    /// Transmittance from the ray's origin to `metres` (infinity is allowed), or to the ground where that is nearer.
    Four transmittance(const Ray& ray, double metres) const;

    /// RGB transmittance of the fog alone. The air is part of the sky.
    glm::dvec3 fogTransmittance(const Ray& ray, double metres) const;
    bool isFog(std::size_t medium) const { return medium >= fogBegin; }

    /// The first collision of light of this throughput before `limit` metres, if there is one: with a molecule (0),
    /// with aerosol (1), or with a fog medium (2 and on).
    std::optional<HazeCollision> collide(const Ray& ray, double limit, const Four& throughput, Random& random) const;

    /// The throughput of a path that reached `metres` without a collision, as `collide` has drawn it.
    Four passed(const Ray& ray, double metres, const Four& throughput) const;

    /// The throughput after the collision, absorption included.
    Four scattered(const Ray& ray, const HazeCollision& collision, const Four& throughput) const;

    /// As Fog::emitted; air gives off no light.
    Four emitted(const Ray& ray, double metres, const Four& throughput, Random& random) const;

    const PhaseFunction& phase(std::size_t medium) const {
        return isFog(medium) ? fog_[medium - fogBegin].phase : phases_[medium];
    }

  private:
    static constexpr std::size_t fogBegin = 2;

    Four opticalDepth(const Ray& ray, double metres) const;
    double heightAt(const glm::dvec3& point) const;
    Four scatteringOf(std::size_t part, double height) const;

    AirMedium medium_;
    /// The same ray where the planet's foot is at the origin.
    Ray aboveFoot(const Ray& ray) const { return {ray.origin - foot_, ray.direction}; }

    double ground_;
    glm::dvec3 foot_;
    std::array<PhaseFunction, 2> phases_;
    FogMedia<Four> fog_;
};

}  // namespace lumulus::reference
