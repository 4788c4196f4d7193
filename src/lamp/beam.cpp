#include "lamp/beam.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lumulus::lamp {

namespace {

using std::numbers::pi;

/// 1 at 0, 0 at 1, level at both ends.
double fade(double t) {
    const double left = 1.0 - std::clamp(t, 0.0, 1.0);
    return left * left * (3.0 - 2.0 * left);
}

/// 1 − cos.
double versine(double angle) {
    return 2.0 * std::sin(0.5 * angle) * std::sin(0.5 * angle);
}

/// Solid angle of a pyramid, whose sides fade between two angles: that of hard sides at the sines p and q of their
/// angles is 4 asin(pq), of which this is the mean by the slope of the fading.
double pyramidSolidAngle(double inner, double outer) {
    const double p = std::sin(inner), q = std::sin(outer);
    constexpr int steps = 128;
    double sum = 0.0, weights = 0.0;
    for (int i = 0; i < steps; ++i)
        for (int j = 0; j < steps; ++j) {
            const double s = (i + 0.5) / steps, t = (j + 0.5) / steps, weight = s * (1.0 - s) * t * (1.0 - t);
            sum += weight * std::asin(std::min(1.0, (p + s * (q - p)) * (p + t * (q - p))));
            weights += weight;
        }
    return 4.0 * sum / weights;
}

/// The roots of a t² + 2 b t + c.
void addRoots(double a, double b, double c, std::vector<double>& roots) {
    if (std::abs(a) < 1e-12) {
        if (b != 0.0) roots.push_back(-0.5 * c / b);
        return;
    }
    const double discriminant = b * b - a * c;
    if (discriminant <= 0.0) return;
    const double q = -(b + std::copysign(std::sqrt(discriminant), b));
    roots.push_back(q / a);
    if (q != 0.0) roots.push_back(c / q);
}

}  // namespace

Beam::Beam(const scene::Lamp& lamp) : lamp_(lamp), outer_(0.5 * lamp.angle * pi / 180.0) {
    inner_ = (1.0 - lamp.softness) * outer_;
    const glm::dvec3 across = glm::cross(lamp.direction, glm::dvec3(0.0, 1.0, 0.0));
    level_ = glm::length(across) > 1e-6 ? glm::normalize(across) : glm::dvec3(1.0, 0.0, 0.0);
    rising_ = glm::normalize(glm::cross(level_, lamp.direction));
    level_ = glm::cross(lamp.direction, rising_);
    widest_ = pi;
    double solidAngle = 4.0 * pi;
    if (lamp.kind == scene::LampKind::spot) {
        widest_ = outer_;
        solidAngle = pi * (versine(inner_) + versine(outer_));
    } else if (lamp.kind == scene::LampKind::pyramid) {
        widest_ = std::atan2(std::numbers::sqrt2 * std::sin(outer_), std::cos(outer_));
        solidAngle = pyramidSolidAngle(inner_, outer_);
    }
    perSolidAngle_ = 1.0 / solidAngle;
}

bool Beam::shinesAs(const Beam& other) const {
    if (lamp_.kind != other.lamp_.kind) return false;
    return isPoint() || (lamp_.direction == other.lamp_.direction && lamp_.angle == other.lamp_.angle &&
                         lamp_.softness == other.lamp_.softness);
}

Beam Beam::inPlaceOfMore(const glm::dvec3& position, const glm::dvec3& power, double radius) const {
    Beam result(*this);
    result.lamp_.position = position;
    result.lamp_.power = power;
    result.lamp_.radius = radius;
    result.shade_ = result.solids_ = DepthMap();
    result.shadedAs_ = this;
    return result;
}

Beam Beam::everywhere() const {
    scene::Lamp lamp = lamp_;
    lamp.kind = scene::LampKind::point;
    lamp.power *= 4.0 * pi * perSolidAngle_;
    return Beam(lamp);
}

double Beam::share(const glm::dvec3& direction) const {
    if (lamp_.kind == scene::LampKind::point) return perSolidAngle_;
    return lamp_.kind == scene::LampKind::spot ? spotShare(direction) : pyramidShare(direction);
}

double Beam::spotShare(const glm::dvec3& direction) const {
    const glm::dvec3 off = direction - lamp_.direction;
    const double away = 0.5 * glm::dot(off, off), from = versine(inner_), to = versine(outer_);
    if (away <= from) return perSolidAngle_;
    return away >= to ? 0.0 : perSolidAngle_ * fade((away - from) / (to - from));
}

double Beam::pyramidShare(const glm::dvec3& direction) const {
    const double ahead = glm::dot(direction, lamp_.direction);
    if (!(ahead > 0.0)) return 0.0;
    double result = perSolidAngle_;
    for (const glm::dvec3& side : {level_, rising_}) {
        const double off = std::abs(glm::dot(direction, side)), sine = off / std::hypot(off, ahead);
        const double from = std::sin(inner_), to = std::sin(outer_);
        if (sine <= from) continue;
        if (sine >= to) return 0.0;
        result *= fade((sine - from) / (to - from));
    }
    return result;
}

void Beam::addCorners(const Ray& ray, std::vector<double>& distances) const {
    if (isPoint()) return;
    const glm::dvec3 from = ray.origin - lamp_.position;
    const double ahead = glm::dot(from, lamp_.direction), rise = glm::dot(ray.direction, lamp_.direction);
    for (const double angle : {inner_, outer_}) {
        if (lamp_.kind == scene::LampKind::spot) {
            const double square = std::cos(angle) * std::cos(angle);
            addRoots(rise * rise - square, ahead * rise - square * glm::dot(from, ray.direction),
                     ahead * ahead - square * glm::dot(from, from), distances);
            continue;
        }
        for (const glm::dvec3& side : {level_, rising_, -level_, -rising_}) {
            const glm::dvec3 normal = std::cos(angle) * side - std::sin(angle) * lamp_.direction;
            const double approach = glm::dot(ray.direction, normal);
            if (approach != 0.0) distances.push_back(-glm::dot(from, normal) / approach);
        }
        if (lamp_.softness == 0.0) break;
    }
    if (rise != 0.0) distances.push_back(-ahead / rise);
}

void Beam::shadeBy(const Clouds& clouds, int edge, const Check& check) {
    const Cone cone = coneToClouds(clouds, lamp_.position, {lamp_.direction, widest_});
    shade_ = DepthMap(clouds, lamp_.position, cone, edge, check);
}

void Beam::shadeBy(const Solids& solids, int edge, const Check& check) {
    const Cone cone = coneToSphere(solids.middle, solids.radius, lamp_.position, {lamp_.direction, widest_});
    solids_ = DepthMap(solids, lamp_.position, cone, edge, check);
}

bool Beam::sample(const glm::dvec3& u, glm::dvec3& direction) const {
    const double away = u.x * versine(widest_), across = std::sqrt(std::max(0.0, away * (2.0 - away)));
    const double azimuth = 2.0 * pi * u.y;
    direction = (1.0 - away) * lamp_.direction + across * (std::cos(azimuth) * level_ + std::sin(azimuth) * rising_);
    return u.z * perSolidAngle_ < share(direction);
}

}  // namespace lumulus::lamp
