#include "lamp/mean_miss.h"

#include <algorithm>
#include <cmath>

#include "lamp/once_scattered.h"

namespace lumulus::lamp {

namespace {

/// ∫∫ 1/r over a rectangle, from one corner: the sum over its four corners with alternating signs.
double inverseOver(double x, double y) {
    const double ax = std::max(std::abs(x), 1e-12), ay = std::max(std::abs(y), 1e-12);
    return x * std::asinh(y / ax) + y * std::asinh(x / ay);
}

}  // namespace

double meanMiss(const Camera& camera, const glm::dvec2& place, double edge, const Ray& ray, const glm::dvec3& lamp) {
    const double miss = missOf(ray, lamp), along = glm::dot(lamp - ray.origin, ray.direction);
    if (along <= 0.0) return miss;
    const double half = 0.5 * edge;
    const auto reach = [&](const glm::dvec2& way) {
        const Ray to = camera.ray(place.x + half * way.x, place.y + half * way.y);
        const Ray from = camera.ray(place.x - half * way.x, place.y - half * way.y);
        return to.origin - from.origin + (to.direction - from.direction) * along;
    };
    const glm::dvec3 right = reach({1.0, 0.0}), down = reach({0.0, 1.0});
    const double width = glm::length(right), height = glm::length(down);
    if (miss > 8.0 * std::max(width, height)) return miss;
    const glm::dvec3 off = lamp - ray.origin - along * ray.direction;
    const double x = glm::dot(off, right) / width, y = glm::dot(off, down) / height;
    const double x0 = x - 0.5 * width, x1 = x + 0.5 * width, y0 = y - 0.5 * height, y1 = y + 0.5 * height;
    const double mean =
        (inverseOver(x1, y1) - inverseOver(x0, y1) - inverseOver(x1, y0) + inverseOver(x0, y0)) / (width * height);
    return 1.0 / mean;
}

}  // namespace lumulus::lamp
