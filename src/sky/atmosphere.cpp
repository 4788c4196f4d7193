#include "sky/atmosphere.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sky/shell.h"
#include "sky/sun_reach.h"

namespace lumulus::sky {

using std::numbers::pi;

namespace {

Air airAbove(scene::Sky sky, const std::optional<scene::Ground>& ground) {
    if (ground) sky.groundAlbedo = ground->albedo;
    return airOf(sky);
}

}  // namespace

Atmosphere::Atmosphere(const scene::Sky& sky, const std::optional<scene::Ground>& ground, double angularDiameter)
    : Atmosphere(airAbove(sky, ground), ground ? ground->height : 0.0, angularDiameter) {
    if (ground) foot_ = ground->foot;
}

Atmosphere::Atmosphere(const Air& air, double groundHeight, double angularDiameter)
    : discRadius_(0.5 * glm::radians(std::max(angularDiameter, 1e-3))),
      groundHeight_(groundHeight),
      air_(air),
      multiple_(air_, columns_, discRadius_) {}

Atmosphere Atmosphere::withGround(const glm::dvec3& albedo) const {
    Air air = air_;
    air.groundAlbedo = air.reflectance(albedo);
    Atmosphere made(air, groundHeight_, glm::degrees(2.0 * discRadius_));
    made.foot_ = foot_;
    return made;
}

double Atmosphere::heightAt(const glm::dvec3& point) const {
    const double y = point.y - groundHeight_;
    const glm::dvec2 aside = glm::dvec2(point.x, point.z) - foot_;
    const double q = y * (2.0 * planetRadius + y) + glm::dot(aside, aside);
    return q / (planetRadius + std::sqrt(std::max(0.0, planetRadius * planetRadius + q)));
}

glm::dvec3 Atmosphere::upAt(const glm::dvec3& point) const {
    return glm::normalize(glm::dvec3(point.x - foot_.x, point.y - groundHeight_ + planetRadius, point.z - foot_.y));
}

AirPoint Atmosphere::at(const glm::dvec3& point, const glm::dvec3& direction, const glm::dvec3& toSun) const {
    const glm::dvec3 up = upAt(point);
    return {std::max(0.0, heightAt(point)), std::clamp(glm::dot(direction, up), -1.0, 1.0),
            std::clamp(glm::dot(toSun, up), -1.0, 1.0), std::clamp(glm::dot(direction, toSun), -1.0, 1.0)};
}

Spectrum Atmosphere::sunTransmittance(double height, double sun) const {
    return sky::sunTransmittance(air_, columns_, height, sun, discRadius_);
}

Spectrum Atmosphere::groundRadiance(double sun) const {
    const Spectrum direct = std::max(0.0, sun) * sunTransmittance(0.0, sun);
    return air_.groundAlbedo / pi * (direct + multiple_.groundIrradiance(sun));
}

AirPath Atmosphere::path(double height, double up, int steps) const {
    return makeAirPath(air_, height, up, distanceToGround(height, up), steps);
}

AirLight Atmosphere::along(const AirPoint& from, const AirPath& path) const {
    AirLight light;
    light.transmittance = path.transmittance;
    const Spectrum molecules = moleculePhase(from.toSun) * air_.molecules;
    for (const AirStep& step : path.steps) {
        const AirPoint p = pointOf(from, step);
        const Spectrum sun = sunTransmittance(p.height, p.sun) * step.weight;
        light.scattered += step.weight * multiple_.source(p, step.density) + step.density.molecules * molecules * sun;
        light.aerosol += step.density.aerosol * sun;
    }
    light.aerosol *= air_.aerosolScattering;
    return light;
}

AirLight Atmosphere::along(const AirPoint& from, double length, int steps) const {
    return along(from, makeAirPath(air_, from.height, from.up, length, steps));
}

AirLight Atmosphere::sky(const AirPoint& from, const AirPath& path) const {
    AirLight light = along(from, path);
    const double ground = distanceToGround(from.height, from.up);
    if (std::isfinite(ground)) light.scattered += light.transmittance * groundRadiance(from.after(ground).sun);
    return light;
}

AirLight Atmosphere::sky(const AirPoint& from, int steps) const {
    return sky(from, path(from.height, from.up, steps));
}

void Atmosphere::extend(AirLight& light, const AirPoint& from, double length, int steps) const {
    const AirLight more = along(from, length, steps);
    light.scattered += light.transmittance * more.scattered;
    light.aerosol += light.transmittance * more.aerosol;
    light.transmittance *= more.transmittance;
}

glm::dvec3 Atmosphere::radiance(const glm::dvec3& point, const glm::dvec3& direction, const glm::dvec3& toSun) const {
    const AirPoint from = at(point, direction, toSun);
    const AirLight light = sky(from);
    const bool ground = std::isfinite(distanceToGround(from.height, from.up));
    return glm::max(air_.rgb(light.light(air_, from.toSun)), glm::dvec3(0.0)) + night(ground, light.transmittance);
}

glm::dvec3 Atmosphere::night(bool ground, const Spectrum& transmittance) const {
    if (transmittance == Spectrum(1.0)) return glm::dvec3(0.0);
    const glm::dvec3 light(nightLuminance / lumensPerWatt);
    if (!ground) return light;
    return light * (1.0 - air_.rgb(transmittance * (1.0 - air_.groundAlbedo)) / sunAbove());
}

glm::dvec3 Atmosphere::sunIrradiance(const glm::dvec3& point, const glm::dvec3& toSun) const {
    const AirPoint here = at(point, toSun, toSun);
    return glm::max(air_.rgb(sunTransmittance(here.height, here.sun)), glm::dvec3(0.0));
}

glm::dvec3 Atmosphere::sunColour(const glm::dvec3& point, const glm::dvec3& toSun) const {
    return sunIrradiance(point, toSun) / sunAbove();
}

glm::dvec3 Atmosphere::skyIrradiance(const glm::dvec3& point, const glm::dvec3& toSun) const {
    // midpoint rule: uniform in the square root of the height above the horizon, and in azimuth
    constexpr int rows = 48, columns = 96;
    const AirPoint here = at(point, toSun, toSun);
    const double across = std::sqrt(std::max(0.0, 1.0 - here.sun * here.sun));
    const auto row = [&](const tbb::blocked_range<int>& range, Spectrum sum) {
        for (int j = range.begin(); j != range.end(); ++j) {
            const double root = (j + 0.5) / rows, up = root * root, sine = std::sqrt(1.0 - up * up);
            for (int i = 0; i < columns; ++i) {
                const double toTheSun = up * here.sun + sine * across * std::cos(pi * (i + 0.5) / columns);
                const AirPoint from{here.height, up, here.sun, toTheSun};
                sum += sky(from).light(air_, toTheSun) * (up * 2.0 * root / rows * 2.0 * pi / columns);
            }
        }
        return sum;
    };
    return glm::max(air_.rgb(tbb::parallel_deterministic_reduce(tbb::blocked_range<int>(0, rows, 4), Spectrum(0.0), row,
                                                                std::plus<>())),
                    glm::dvec3(0.0));
}

}  // namespace lumulus::sky
