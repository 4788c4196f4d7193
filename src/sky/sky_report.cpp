#include "sky/sky_report.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/ephemeris.h"
#include "sky/environment.h"

namespace lumulus::sky {
namespace {

/// CIE 1931 x and y of linear Rec. 709.
glm::dvec2 chromaticityOf(const glm::dvec3& rgb) {
    const glm::dvec3 xyz(glm::dot(rgb, glm::dvec3(0.4123908, 0.3575843, 0.1804808)),
                         glm::dot(rgb, glm::dvec3(0.2126390, 0.7151687, 0.0721923)),
                         glm::dot(rgb, glm::dvec3(0.0193308, 0.1191948, 0.9505322)));
    const double sum = xyz.x + xyz.y + xyz.z;
    return sum > 0.0 ? glm::dvec2(xyz.x, xyz.y) / sum : glm::dvec2(0.0);
}

Luminary luminary(const Environment& environment, const glm::dvec3& point, const glm::dvec3& toIt,
                  const glm::dvec3& above) {
    Luminary result;
    const double azimuth = glm::degrees(std::atan2(toIt.x, -toIt.z));
    result.azimuth = azimuth < 0.0 ? azimuth + 360.0 : azimuth;
    result.elevation = glm::degrees(std::asin(std::clamp(toIt.y, -1.0, 1.0)));
    result.irradiance = above * environment.sunTransmittance(point, toIt);
    result.illuminance = photometric(result.irradiance);
    result.chromaticity = chromaticityOf(result.irradiance);
    return result;
}

/// What the sky has by a sun or moon.
struct Diffuse {
    double illuminance = 0.0, zenith = 0.0, horizon = 0.0;

    void add(const Atmosphere& atmosphere, const glm::dvec3& point, const glm::dvec3& toIt, const glm::dvec3& above) {
        const glm::dvec3 share = above / atmosphere.sunAbove(), up = atmosphere.upAt(point);
        const glm::dvec3 level = toIt - glm::dot(toIt, up) * up;
        const double length = glm::length(level);
        const glm::dvec3 away = length > 1e-9 ? -level / length : glm::dvec3(0.0, 0.0, -1.0);
        const double low = glm::radians(2.0);
        illuminance += photometric(atmosphere.skyIrradiance(point, toIt) * share);
        zenith += photometric(atmosphere.radiance(point, up, toIt) * share);
        horizon += photometric(
            atmosphere.radiance(point, glm::normalize(std::cos(low) * away + std::sin(low) * up), toIt) * share);
    }
};

}  // namespace

glm::dvec3 observerOf(const scene::Scene& scene) {
    constexpr double eyeHeight = 2.0;
    const double ground = scene.ground ? scene.ground->height : 0.0;
    return scene.camera.position.value_or(glm::dvec3(0.0, ground + eyeHeight, 0.0));
}

SkyReport reportSky(const scene::Scene& scene, const glm::dvec3& point) {
    const Environment environment(scene.sky, scene.ground, scene.sun.angularDiameter);
    const scene::Sun sun = environment.sunOf(scene.sun);
    const glm::dvec3 moonAbove = scene.sun.irradiance * scene::moonShare(scene.moon.phaseAngle);
    SkyReport report;
    report.sun = luminary(environment, point, sun.directionTo, sun.irradiance);
    report.moon = luminary(environment, point, scene.moon.directionTo, moonAbove);
    report.refraction = scene::refraction(report.sun.elevation);
    report.moonPhaseAngle = scene.moon.phaseAngle;
    Diffuse sky;
    if (const Atmosphere* atmosphere = environment.atmosphere()) {
        sky.add(*atmosphere, point, scene.sun.directionTo, scene.sun.irradiance);
        if (scene.moon.shines) sky.add(*atmosphere, point, scene.moon.directionTo, moonAbove);
        sky.illuminance += std::numbers::pi * nightLuminance;
    } else if (const MapSky* map = environment.map()) {
        sky.illuminance = photometric(map->irradiance({0.0, 1.0, 0.0}));
        sky.zenith = photometric(map->radiance({0.0, 1.0, 0.0}));
        sky.horizon = photometric(map->radiance(scene::skyDirection(report.sun.azimuth + 180.0, 2.0)));
    } else {
        sky.zenith = sky.horizon = photometric(environment.radiance(point, {0.0, 1.0, 0.0}, scene.sun));
        sky.illuminance = std::numbers::pi * sky.zenith;
    }
    report.skyIlluminance = sky.illuminance;
    report.zenithLuminance = sky.zenith;
    report.horizonLuminance = sky.horizon;
    return report;
}

}  // namespace lumulus::sky
