#include "sky/environment.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "scene/ephemeris.h"

namespace lumulus::sky {

Environment::Environment(const scene::Sky& sky, const std::optional<scene::Ground>& ground, double angularDiameter,
                         const std::optional<scene::Sun>& moon, std::shared_ptr<const Atmosphere> air)
    : radiance_(sky.model == scene::SkyModel::constant ? sky.radiance : glm::dvec3(0.0)) {
    if (sky.model == scene::SkyModel::map) map_ = std::make_shared<const MapSky>(sky);
    if (sky.model == scene::SkyModel::atmosphere)
        atmosphere_ = air ? std::move(air) : std::make_shared<const Atmosphere>(sky, ground, angularDiameter);
    if (atmosphere_) moon_ = moon;
}

glm::dvec3 Environment::radiance(const glm::dvec3& point, const glm::dvec3& direction, const scene::Sun& sun) const {
    if (map_) return map_->radiance(direction);
    if (!atmosphere_) return radiance_;
    const auto lit = [&](const scene::Sun& by) {
        return atmosphere_->radiance(point, direction, by.directionTo) * (by.irradiance / atmosphere_->sunAbove());
    };
    return moon_ ? lit(sun) + lit(*moon_) : lit(sun);
}

glm::dvec3 Environment::meanRadiance(const glm::dvec3& point, const scene::Sun& sun) const {
    if (map_) return map_->mean();
    if (!atmosphere_) return radiance_;
    constexpr int rows = 16, columns = 8;
    glm::dvec3 sum(0.0);
    for (int i = 0; i < rows * columns; ++i) {
        const double height = -1.0 + 2.0 * (i / columns + 0.5) / rows, across = std::sqrt(1.0 - height * height);
        const double azimuth = 2.0 * std::numbers::pi * (i % columns + 0.5) / columns;
        sum += radiance(point, {across * std::cos(azimuth), height, across * std::sin(azimuth)}, sun);
    }
    return sum / static_cast<double>(rows * columns);
}

glm::dvec3 Environment::sunTransmittance(const glm::dvec3& point, const glm::dvec3& directionTo) const {
    return atmosphere_ ? atmosphere_->sunColour(point, directionTo) : glm::dvec3(1.0);
}

AerialPerspective Environment::between(const glm::dvec3& from, const glm::dvec3& to, const scene::Sun& sun) const {
    const double distance = glm::length(to - from);
    if (!atmosphere_ || !(distance > 0.0)) return {};
    const Air& air = atmosphere_->air();
    const glm::dvec3 above = atmosphere_->sunAbove(), none(0.0);
    AerialPerspective seen;
    seen.radiance = none;
    for (const scene::Sun* by : {&sun, moon_ ? &*moon_ : nullptr}) {
        if (by == nullptr) continue;
        const AirPoint start = atmosphere_->at(from, (to - from) / distance, by->directionTo);
        const AirLight light = atmosphere_->along(start, distance);
        seen.transmittance = glm::max(air.rgb(light.transmittance), none) / above;
        const glm::dvec3 night = (1.0 - seen.transmittance) * atmosphere_->night(false, light.transmittance);
        seen.radiance += (glm::max(air.rgb(light.light(air, start.toSun)), none) + night) * (by->irradiance / above);
    }
    return seen;
}

bool Environment::isDark(const scene::Sun& sun) const {
    if (map_) return false;  // it would not have been read
    const glm::dvec3& light = atmosphere_ ? sun.irradiance : radiance_;
    return !(light.x > 0.0 || light.y > 0.0 || light.z > 0.0);
}

EnvironmentSample Environment::sample(const glm::dvec2& u) const {
    const double height = 1.0 - 2.0 * u.x, across = 2.0 * std::sqrt(u.x * (1.0 - u.x));
    const double azimuth = 2.0 * std::numbers::pi * u.y;
    return {{across * std::cos(azimuth), height, across * std::sin(azimuth)}, radiance_, 0.25 * std::numbers::inv_pi};
}

glm::dvec3 Environment::fluxThrough(const glm::dmat3& faceArea) const {
    double area = 0.0;
    for (int axis = 0; axis < 3; ++axis) area += 2.0 * glm::length(faceArea[axis]);
    return radiance_ * (std::numbers::pi * area);
}

std::optional<scene::Sun> moonOf(const scene::Scene& scene) {
    if (!scene.moon.shines || scene.sky.model != scene::SkyModel::atmosphere) return std::nullopt;
    scene::Sun moon;
    moon.directionTo = scene.moon.directionTo;
    moon.irradiance = scene.sun.irradiance * scene::moonShare(scene.moon.phaseAngle);
    moon.angularDiameter = scene.sun.angularDiameter;
    return moon;
}

}  // namespace lumulus::sky
