#include "reference/fog_on_ray.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "reference/ground.h"

namespace lumulus::reference {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

using Intervals = std::array<Interval, 2>;

/// The part of the ray whose height lies between two planes.
Interval betweenPlanes(const scene::FogMedium& medium, const Ray& ray) {
    const double rise = ray.direction.y, toBottom = medium.bottom - ray.origin.y, toTop = medium.top - ray.origin.y;
    if (rise == 0.0) return toBottom <= 0.0 && toTop >= 0.0 ? Interval{0.0, infinity} : Interval{};
    const double first = std::min(toBottom / rise, toTop / rise), last = std::max(toBottom / rise, toTop / rise);
    return last > 0.0 ? Interval{std::max(0.0, first), last} : Interval{};
}

/// The parts of the ray between two spheres around the planet's middle.
Intervals betweenShells(const scene::FogMedium& medium, const Ray& ray, double planet) {
    const glm::dvec3 fromMiddle = ray.origin - glm::dvec3(0.0, planet - planetRadius, 0.0);
    const double closest = -glm::dot(fromMiddle, ray.direction);
    const double miss = glm::length(glm::cross(fromMiddle, ray.direction));
    const auto halfChord = [&](double height) {
        const double radius = planetRadius + height - planet;
        return radius > miss ? std::sqrt((radius - miss) * (radius + miss)) : 0.0;
    };
    const double outer = halfChord(medium.top), inner = halfChord(medium.bottom);
    const auto part = [&](double begin, double end) { return Interval{std::max(0.0, begin), std::max(0.0, end)}; };
    if (inner == 0.0) return {part(closest - outer, closest + outer), Interval{}};
    return {part(closest - outer, closest - inner), part(closest + inner, closest + outer)};
}

Intervals partsOf(const scene::FogMedium& medium, const Ray& ray, const std::optional<double>& planet) {
    if (!std::isfinite(medium.bottom) && !std::isfinite(medium.top)) return {Interval{0.0, infinity}, Interval{}};
    if (planet) return betweenShells(medium, ray, *planet);
    return {betweenPlanes(medium, ray), Interval{}};
}

}  // namespace

FogOnRay::FogOnRay(const scene::FogMedium& medium, const Ray& ray, const std::optional<double>& planet) {
    const Intervals parts = partsOf(medium, ray, planet);
    for (std::size_t i = 0; i < parts.size(); ++i)
        if (parts[i].begin < parts[i].end) parts_[i] = FogDensity(medium, ray, parts[i], planet);
}

double FogOnRay::metresTo(double path) const {
    const double first = parts_[0].metresTo(path);
    return first < infinity ? first : parts_[1].metresTo(std::max(0.0, path - parts_[0].pathTo(infinity)));
}

}  // namespace lumulus::reference
