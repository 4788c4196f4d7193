#include "sky/environment.h"

#include <cmath>
#include <numbers>

namespace lumulus::sky {

glm::dvec3 Environment::radiance(const glm::dvec3&) const {
    return radiance_;
}

EnvironmentSample Environment::sample(const glm::dvec2& u) const {
    const double height = 1.0 - 2.0 * u.x, across = 2.0 * std::sqrt(u.x * (1.0 - u.x));
    const double azimuth = 2.0 * std::numbers::pi * u.y;
    return {{across * std::cos(azimuth), height, across * std::sin(azimuth)}, radiance_, 0.25 * std::numbers::inv_pi};
}

glm::dvec3 Environment::sunTransmittance(const glm::dvec3&, const glm::dvec3&) const {
    return glm::dvec3(1.0);
}

AerialPerspective Environment::between(const glm::dvec3&, const glm::dvec3&) const {
    return {};
}

glm::dvec3 Environment::fluxThrough(const glm::dmat3& faceArea) const {
    double area = 0.0;
    for (int axis = 0; axis < 3; ++axis) area += 2.0 * glm::length(faceArea[axis]);
    return radiance_ * (std::numbers::pi * area);
}

bool Environment::isDark() const {
    return !(radiance_.x > 0.0 || radiance_.y > 0.0 || radiance_.z > 0.0);
}

}  // namespace lumulus::sky
