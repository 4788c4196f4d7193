#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <numbers>

#include "light/photon/photon_map.h"
#include "medium/scattering_tables.h"
#include "scene/scene.h"

namespace lumulus::test {

inline scene::Sun sunFrom(const glm::dvec3& directionTo, const glm::dvec3& irradiance, double angularDiameter = 0.0) {
    return {glm::normalize(directionTo), irradiance, angularDiameter};
}
inline scene::Sun noSun() {
    return sunFrom({0.0, 1.0, 0.0}, glm::dvec3(0.0));
}
inline scene::Sky skyOf(const glm::dvec3& radiance) {
    scene::Sky sky;
    sky.radiance = radiance;
    return sky;
}

struct MediumOptions {
    double extinction = 1.0;  ///< 1/m where the normalised density is 1
    glm::dvec3 albedo{1.0};
    scene::Phase phase{};
    int bands = 1;
    double cut = 0.0;  ///< degrees
};

inline photon::Medium mediumOf(const MediumOptions& options) {
    photon::Medium medium;
    medium.extinction = options.extinction;
    medium.albedo = options.albedo;
    medium.tables = phase::makeScatteringTables(options.phase, options.cut * std::numbers::pi / 180.0, options.albedo,
                                                options.bands, 0.0);
    return medium;
}

/// The same medium with another albedo, without making the tables anew: those of the photon walk do not depend on it.
inline photon::Medium withAlbedo(photon::Medium medium, const glm::dvec3& albedo) {
    medium.albedo = albedo;
    return medium;
}

inline photon::Options mapOptions(std::uint64_t photons, int generations, int bands, std::uint64_t seed = 1) {
    photon::Options options;
    options.photonsPerGeneration = photons;
    options.generations = generations;
    options.bands = bands;
    options.seed = seed;
    options.keepRing = true;
    return options;
}

/// Value of coefficient `i` of a collector in the layout of the ring.
inline double coefficient(const std::vector<std::int64_t>& counts, std::size_t collector, int channel, int i,
                          int bands) {
    const auto each = static_cast<std::size_t>(bands * bands);
    return static_cast<double>(
        counts[(collector * 3 + static_cast<std::size_t>(channel)) * each + static_cast<std::size_t>(i)]);
}

}  // namespace lumulus::test
