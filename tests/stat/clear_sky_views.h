#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "scene/scene.h"

namespace lumulus {

/// Views of a clear sky from 2 m above the ground that the tables of the sky are held against the reference in.
struct ClearSky {
    static constexpr std::array<double, 7> suns{60.0, 30.0, 10.0, 2.0, 0.0, -2.0, -4.0};  ///< elevations, degrees
    static constexpr std::size_t views = 16;
    static constexpr glm::dvec3 eye{0.0, 2.0, 0.0};

    /// Five elevations at three azimuths from the sun's (which is 0), and the zenith.
    static glm::dvec3 view(std::size_t index) {
        constexpr std::array<double, 5> elevations{0.5, 3.0, 10.0, 25.0, 50.0};
        constexpr std::array<double, 3> azimuths{20.0, 90.0, 180.0};
        if (index + 1 == views) return {0.0, 1.0, 0.0};
        return scene::skyDirection(azimuths.at(index % 3), elevations.at(index / 3));
    }

    /// The default medium over a ground of albedo 0.2.
    static scene::Scene scene(double sunElevation) {
        scene::Scene scene;
        scene.sky.model = scene::SkyModel::atmosphere;
        scene.sun.directionTo = scene::skyDirection(0.0, sunElevation);
        scene.sun.irradiance = {210.45, 189.23, 185.23};
        return scene;
    }

    /// Luminance in cd/m² of a radiance in W·m⁻²·sr⁻¹.
    static double luminance(const glm::dvec3& rgb) { return 683.0 * glm::dot(rgb, glm::dvec3(0.2126, 0.7152, 0.0722)); }
};

}  // namespace lumulus
