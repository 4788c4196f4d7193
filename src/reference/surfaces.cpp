#include "reference/surfaces.h"

#include <cmath>

namespace lumulus::reference {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

double metresToPlane(const scene::Surface& plane, const Ray& ray, bool leaves) {
    const double approach = glm::dot(ray.direction, plane.normal);
    if (leaves || approach == 0.0) return never;
    const double metres = glm::dot(plane.position - ray.origin, plane.normal) / approach;
    return metres > 0.0 ? metres : never;
}

double metresToDisc(const scene::Surface& disc, const Ray& ray, bool leaves) {
    const double metres = metresToPlane(disc, ray, leaves);
    if (metres == never) return never;
    return glm::distance(ray.origin + metres * ray.direction, disc.position) < disc.radius ? metres : never;
}

double metresToSphere(const scene::Surface& sphere, const Ray& ray, bool leaves) {
    const glm::dvec3 toMiddle = sphere.position - ray.origin;
    const double closest = glm::dot(toMiddle, ray.direction);
    // on the sphere itself one of the two points is the origin
    if (leaves) return closest > 0.0 ? 2.0 * closest : never;
    const double distance = glm::length(glm::cross(toMiddle, ray.direction));
    if (!(distance < sphere.radius)) return never;
    const double half = std::sqrt((sphere.radius - distance) * (sphere.radius + distance));
    if (closest - half > 0.0) return closest - half;
    // a point that should lie on the sphere may lie just within it
    const double rounding = closest < 0.0 ? 1e-12 * sphere.radius : 0.0;
    return closest + half > rounding ? closest + half : never;
}

double metresTo(const scene::Surface& surface, const Ray& ray, bool leaves) {
    switch (surface.kind) {
        case scene::SurfaceKind::plane:
            return metresToPlane(surface, ray, leaves);
        case scene::SurfaceKind::sphere:
            return metresToSphere(surface, ray, leaves);
        case scene::SurfaceKind::disc:
            break;
    }
    return metresToDisc(surface, ray, leaves);
}

}  // namespace

std::optional<SurfaceHit> Surfaces::nearest(const Ray& ray, std::size_t from) const {
    SurfaceHit hit{never, none};
    for (std::size_t i = 0; i < surfaces_.size(); ++i) {
        const double metres = metresTo(surfaces_[i], ray, i == from);
        if (metres < hit.metres) hit = {metres, i};
    }
    if (hit.surface == none) return std::nullopt;
    return hit;
}

glm::dvec3 Surfaces::normalAgainst(const glm::dvec3& direction, const glm::dvec3& point, std::size_t surface) const {
    const scene::Surface& s = surfaces_[surface];
    const glm::dvec3 normal = s.kind == scene::SurfaceKind::sphere ? (point - s.position) / s.radius : s.normal;
    return glm::dot(direction, normal) > 0.0 ? -normal : normal;
}

}  // namespace lumulus::reference
