#include "reference/lamp_light.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace lumulus::reference {
namespace {

constexpr double pi = glm::pi<double>();

/// 1 − cos of an angle, with all digits of small ones.
double versine(double angle) {
    const double half = std::sin(0.5 * angle);
    return 2.0 * half * half;
}

/// 1 before `inner`, 0 behind `outer`, a cubic without corners between.
double fade(double x, double inner, double outer) {
    if (x <= inner) return 1.0;
    if (x >= outer) return 0.0;
    const double t = (outer - x) / (outer - inner);
    return t * t * (3.0 - 2.0 * t);
}

/// Solid angle of a pyramid whose sides fade between two sines of the angle to the axis: dω = (1 − p²q²)^(−3/2) dp dq
/// in the sines p and q, whose integral over [0, p] × [0, q] is asin(pq). By parts this is the mean of asin(pq) over
/// the places p and q of an edge, whose density is that of the fade's slope.
double pyramidSolidAngle(double inner, double outer) {
    constexpr int steps = 400;
    double sum = 0.0, weights = 0.0;
    for (int i = 0; i < steps; ++i) {
        for (int j = 0; j < steps; ++j) {
            const double s = (i + 0.5) / steps, t = (j + 0.5) / steps;
            const double weight = s * (1.0 - s) * t * (1.0 - t);
            sum += weight * std::asin((inner + s * (outer - inner)) * (inner + t * (outer - inner)));
            weights += weight;
        }
    }
    return 4.0 * sum / weights;
}

}  // namespace

LampLight::LampLight(const scene::Lamp& lamp)
    : kind_(lamp.kind), axis_(lamp.direction), halfAngle_(glm::radians(0.5 * lamp.angle)), widest_(halfAngle_) {
    const double inner = (1.0 - lamp.softness) * halfAngle_;
    double solidAngle = 4.0 * pi;
    innerEdge_ = outerEdge_ = 0.0;
    if (kind_ == scene::LampKind::point) widest_ = pi;
    if (kind_ == scene::LampKind::spot) {
        innerEdge_ = versine(inner);
        outerEdge_ = versine(halfAngle_);
        solidAngle = pi * (innerEdge_ + outerEdge_);
    }
    if (kind_ == scene::LampKind::pyramid) {
        innerEdge_ = std::sin(inner);
        outerEdge_ = std::sin(halfAngle_);
        solidAngle =
            lamp.softness > 0.0 ? pyramidSolidAngle(innerEdge_, outerEdge_) : 4.0 * std::asin(outerEdge_ * outerEdge_);
        const glm::dvec3 up(0.0, 1.0, 0.0), across = glm::cross(axis_, up);
        level_ = glm::length(across) > 1e-6 ? glm::normalize(across) : glm::dvec3(1.0, 0.0, 0.0);
        rising_ = glm::normalize(glm::cross(level_, axis_));
        level_ = glm::cross(axis_, rising_);
        widest_ = std::atan2(std::sqrt(2.0) * std::sin(halfAngle_), std::cos(halfAngle_));
    }
    brightest_ = 1.0 / solidAngle;
    radiancePerShare_ = lamp.power / (pi * lamp.radius * lamp.radius);
}

double LampLight::share(const glm::dvec3& direction) const {
    if (kind_ == scene::LampKind::point) return brightest_;
    const glm::dvec3 off = direction - axis_;
    if (kind_ == scene::LampKind::spot) return brightest_ * fade(0.5 * glm::dot(off, off), innerEdge_, outerEdge_);
    const double z = glm::dot(direction, axis_);
    if (!(z > 0.0)) return 0.0;
    const double x = std::abs(glm::dot(direction, level_)), y = std::abs(glm::dot(direction, rising_));
    return brightest_ * fade(x / std::hypot(x, z), innerEdge_, outerEdge_) *
           fade(y / std::hypot(y, z), innerEdge_, outerEdge_);
}

bool LampLight::reaches(const glm::dvec3& direction, double slack) const {
    const double angle = 2.0 * std::asin(std::min(1.0, 0.5 * glm::length(direction - axis_)));
    return angle - slack <= widest_;
}

}  // namespace lumulus::reference
