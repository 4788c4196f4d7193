#include "reference/fog_density.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/fog_bounds.h"

namespace lumulus::reference {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Longest path. Nothing passes along longer ones, and sums over media stay finite.
constexpr double longestPath = 1e200;

/// (1 − e^{−x})/x for x ≥ 0.
double meanFallOff(double x) {
    return x > 0.0 ? -std::expm1(-x) / x : 1.0;
}

}  // namespace

FogDensity::FogDensity(const scene::FogMedium& medium, const Ray& ray, const Interval& part,
                       const std::optional<double>& planet)
    : kind_(medium.kind), part_(part) {
    if (kind_ == scene::MediumKind::exponential) enterExponential(medium, ray, planet);
    if (kind_ == scene::MediumKind::sphere) enterSphere(medium, ray);
    if (kind_ == scene::MediumKind::ellipsoid) enterEllipsoid(medium, ray);
    if (kind_ == scene::MediumKind::box) enterBox(medium, ray);
}

void FogDensity::enterExponential(const scene::FogMedium& medium, const Ray& ray, const std::optional<double>& planet) {
    if (planet && scene::isLevel(medium) && medium.falloff > 0.0 && part_.begin < part_.end) {
        const double upwards = medium.direction.y > 0.0 ? 1.0 : -1.0;
        shell_.emplace(upwards * medium.falloff, medium.offset.y, *planet, ray, part_);
        return;
    }
    const glm::dvec3 start = ray.origin + part_.begin * ray.direction;
    exponent_ = medium.falloff * glm::dot(start - medium.offset, medium.direction);
    slope_ = medium.falloff * glm::dot(ray.direction, medium.direction);
}

/// Leaves of the part what lies between two places of the ray.
void FogDensity::cut(double begin, double end) {
    part_.begin = std::max(part_.begin, begin);
    part_.end = std::max(part_.begin, std::min(part_.end, end));
}

/// In coordinates in which the ellipsoid is the unit sphere.
void FogDensity::enterEllipsoid(const scene::FogMedium& medium, const Ray& ray) {
    const glm::dvec3 toCentre = (medium.center - ray.origin) / medium.halfSize, along = ray.direction / medium.halfSize;
    const double speed = glm::length(along);
    const double closest = glm::dot(toCentre, along) / speed;
    const double distance = glm::length(glm::cross(toCentre, along)) / speed;
    const double half = distance < 1.0 ? std::sqrt((1.0 - distance) * (1.0 + distance)) : 0.0;
    cut((closest - half) / speed, (closest + half) / speed);
}

void FogDensity::enterBox(const scene::FogMedium& medium, const Ray& ray) {
    for (int axis = 0; axis < 3; ++axis) {
        const double toCentre = medium.center[axis] - ray.origin[axis], half = medium.halfSize[axis];
        const double speed = std::abs(ray.direction[axis]), middle = toCentre / ray.direction[axis];
        if (speed > 0.0)
            cut(middle - half / speed, middle + half / speed);
        else if (std::abs(toCentre) > half)
            cut(part_.begin, part_.begin);
    }
}

void FogDensity::enterSphere(const scene::FogMedium& medium, const Ray& ray) {
    const glm::dvec3 toCentre = medium.center - ray.origin;
    radius_ = medium.radius;
    closest_ = glm::dot(toCentre, ray.direction);
    // by the cross product: the difference of squares loses all digits far from the sphere
    const double distance = glm::length(glm::cross(toCentre, ray.direction));
    halfChord_ = distance < radius_ ? std::sqrt((radius_ - distance) * (radius_ + distance)) : 0.0;
    cut(closest_ - halfChord_, closest_ + halfChord_);
}

double FogDensity::pathTo(double metres) const {
    const double length = std::min(metres, part_.end) - part_.begin;
    if (!(length > 0.0)) return 0.0;
    double path = length;
    if (kind_ == scene::MediumKind::exponential)
        path = shell_ ? shell_->pathTo(part_.begin + length) : exponentialPath(length);
    if (kind_ == scene::MediumKind::sphere) path = spherePath(length);
    return std::min(longestPath, path);
}

double FogDensity::metresTo(double path) const {
    if (shell_) return std::max(part_.begin, shell_->metresTo(path));
    double length = path;
    if (kind_ == scene::MediumKind::exponential) length = exponentialLength(path);
    if (kind_ == scene::MediumKind::sphere) length = sphereLength(path);
    const double metres = part_.begin + length;
    return metres < part_.end ? metres : infinity;
}

/// From the denser end, so that no factor overflows where the integral does not.
double FogDensity::exponentialPath(double length) const {
    if (!std::isfinite(length)) return slope_ > 0.0 ? std::exp(-exponent_) / slope_ : longestPath;
    const double rise = slope_ * length;
    return std::exp(-(exponent_ + std::min(0.0, rise))) * length * meanFallOff(std::abs(rise));
}

double FogDensity::exponentialLength(double path) const {
    if (slope_ == 0.0) return path * std::exp(exponent_);
    const double ratio = std::log(std::abs(slope_) * path) + exponent_;  // ln(|k| P / ϱ of the beginning)
    if (slope_ > 0.0) return ratio < 0.0 ? -std::log1p(-std::exp(ratio)) / slope_ : infinity;
    return (ratio < 700.0 ? std::log1p(std::exp(ratio)) : ratio) / -slope_;
}

/// ϱ = (c² − u²)/R² at u metres beyond the point nearest to the centre, c half the chord.
double FogDensity::spherePath(double length) const {
    const double from = part_.begin - closest_, to = from + length;
    return length * (halfChord_ * halfChord_ - (from * from + from * to + to * to) / 3.0) / (radius_ * radius_);
}

/// c²u − u³/3 = C has the root u = 2c sin(asin(3C/2c³)/3) within the chord.
double FogDensity::sphereLength(double path) const {
    if (!(path < spherePath(part_.end - part_.begin))) return infinity;
    const double from = part_.begin - closest_;
    const double cube = halfChord_ * halfChord_ * halfChord_;
    const double level = from * (halfChord_ * halfChord_ - from * from / 3.0) + path * radius_ * radius_;
    const double to = 2.0 * halfChord_ * std::sin(std::asin(std::clamp(1.5 * level / cube, -1.0, 1.0)) / 3.0);
    return std::max(0.0, to - from);
}

}  // namespace lumulus::reference
