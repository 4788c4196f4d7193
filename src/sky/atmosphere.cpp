#include "sky/atmosphere.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sky/path_steps.h"
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
    : Atmosphere(airAbove(sky, ground), ground ? ground->height : 0.0, angularDiameter) {}

Atmosphere::Atmosphere(const Air& air, double groundHeight, double angularDiameter)
    : discRadius_(0.5 * glm::radians(std::max(angularDiameter, 1e-3))),
      groundHeight_(groundHeight),
      air_(air),
      multiple_(air_, columns_, discRadius_) {}

double Atmosphere::heightAt(const glm::dvec3& point) const {
    const double y = point.y - groundHeight_;
    const double q = y * (2.0 * planetRadius + y) + point.x * point.x + point.z * point.z;
    return q / (planetRadius + std::sqrt(std::max(0.0, planetRadius * planetRadius + q)));
}

glm::dvec3 Atmosphere::upAt(const glm::dvec3& point) const {
    return glm::normalize(glm::dvec3(point.x, point.y - groundHeight_ + planetRadius, point.z));
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

void Atmosphere::add(AirLight& light, const AirPoint& from, double length, int steps) const {
    const PathSteps path(length, -(planetRadius + from.height) * from.up, steps);
    const double molecules = moleculePhase(from.toSun);
    for (int i = 0; i < steps; ++i) {
        const AirPoint p = from.after(path.middle(i));
        const AirDensity density = airDensity(p.height);
        const Spectrum extinction = air_.extinction(density), through = glm::exp(-extinction * path.length(i));
        const Spectrum weight = light.transmittance * (1.0 - through) / glm::max(extinction, Spectrum(1e-30));
        const Spectrum sun = sunTransmittance(p.height, p.sun);
        light.scattered +=
            weight * (multiple_.source(p, density) + molecules * density.molecules * air_.molecules * sun);
        light.aerosol += weight * sun * density.aerosol * air_.aerosolScattering;
        light.transmittance *= through;
    }
}

AirLight Atmosphere::along(const AirPoint& from, double length, int steps) const {
    AirLight light;
    extend(light, from, length, steps);
    return light;
}

void Atmosphere::extend(AirLight& light, const AirPoint& from, double length, int steps) const {
    AirPoint inside = from;
    if (from.height > airTop) {
        const double entry = distanceToAir(from.height, from.up);
        if (!(entry < length)) return;
        inside = from.after(entry);
        inside.height = std::min(inside.height, airTop);
        length -= entry;
    }
    add(light, inside, std::min(length, distanceToTop(inside.height, inside.up)), steps);
}

AirLight Atmosphere::sky(const AirPoint& from, int steps) const {
    const double ground = distanceToGround(from.height, from.up);
    AirLight light = along(from, ground, steps);
    if (std::isfinite(ground)) light.scattered += light.transmittance * groundRadiance(from.after(ground).sun);
    return light;
}

glm::dvec3 Atmosphere::radiance(const glm::dvec3& point, const glm::dvec3& direction, const glm::dvec3& toSun) const {
    const AirPoint from = at(point, direction, toSun);
    return glm::max(air_.rgb(sky(from).light(air_, from.toSun)), glm::dvec3(0.0));
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
