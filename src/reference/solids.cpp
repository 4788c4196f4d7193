#include "reference/solids.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "reference/ground.h"
#include "reference/lamps.h"
#include "reference/phase.h"

namespace lumulus::reference {
namespace {

/// Axes with the normal as the third one.
struct Frame {
    glm::dvec3 x, y, z;

    explicit Frame(const glm::dvec3& normal) : z(normal) {
        const glm::dvec3 other = std::abs(z.x) < 0.5 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
        x = glm::normalize(glm::cross(other, z));
        y = glm::cross(z, x);
    }
    glm::dvec3 into(const glm::dvec3& v) const { return {glm::dot(v, x), glm::dot(v, y), glm::dot(v, z)}; }
    glm::dvec3 outOf(const glm::dvec3& v) const { return v.x * x + v.y * y + v.z * z; }
};

}  // namespace

Solids::Solids(const scene::Scene& scene, bool glow)
    : surfaces_(withLamps(surfacesOf(scene), scene.lamps)), things_(surfacesOf(scene)), meshes_(scene), glow_(glow) {}

std::optional<SolidHit> Solids::nearest(const Ray& ray, const SolidPoint& from) const {
    std::optional<SolidHit> hit;
    if (!surfaces_.empty()) {
        if (const auto surface = surfaces_.nearest(ray, from.surface))
            hit = SolidHit{surface->metres, surface->surface, std::nullopt};
    }
    if (meshes_.empty()) return hit;
    const auto mesh = meshes_.nearest(ray, hit ? hit->metres : std::numeric_limits<double>::infinity(),
                                      from.mesh ? &*from.mesh : nullptr);
    if (mesh) hit = SolidHit{mesh->metres, Surfaces::none, mesh};
    return hit;
}

std::optional<double> Solids::thing(const Ray& ray) const {
    const auto surface = things_.nearest(ray, Surfaces::none);
    const auto mesh =
        meshes_.nearest(ray, surface ? surface->metres : std::numeric_limits<double>::infinity(), nullptr);
    if (mesh) return mesh->metres;
    return surface ? std::optional(surface->metres) : std::nullopt;
}

SolidPoint Solids::at(const glm::dvec3& direction, const glm::dvec3& place, const SolidHit& hit) const {
    SolidPoint point;
    if (!hit.mesh) {
        point.surface = hit.surface;
        point.normal = surfaces_.normalAgainst(direction, place, hit.surface);
        return point;
    }
    point.mesh = hit.mesh;
    point.facets = meshes_.at({place, direction}, *hit.mesh);
    point.normal = point.facets.normal;
    return point;
}

glm::dvec3 Solids::albedo(const SolidPoint& point) const {
    return point.mesh ? glm::dvec3(1.0) : surfaces_[point.surface].albedo;
}

glm::dvec3 Solids::meshEmission(const Ray& ray, const SolidHit& hit) const {
    return hit.mesh && glow_ ? meshes_.at(ray, *hit.mesh).emission : glm::dvec3(0.0);
}

glm::dvec3 Solids::turn(const SolidPoint& point, const glm::dvec3& arrived, Random& random) const {
    if (!point.mesh) return turned(point.normal, 1.0 - std::sqrt(random.uniform()), random);
    const Frame frame(point.normal);
    return frame.outOf(meshes_.reflection(point.facets).sample(frame.into(-arrived), random));
}

double Solids::density(const SolidPoint& point, const glm::dvec3& arrived, const glm::dvec3& direction) const {
    if (!point.mesh) return std::max(0.0, glm::dot(point.normal, direction)) * glm::one_over_pi<double>();
    // light does not come through the triangle, whatever its normal is taken for
    if (!(glm::dot(point.facets.faceNormal, direction) > 0.0)) return 0.0;
    const Frame frame(point.normal);
    return meshes_.reflection(point.facets).density(frame.into(-arrived), frame.into(direction));
}

glm::dvec3 Solids::shade(const SolidPoint& point, const glm::dvec3& arrived, const glm::dvec3& direction) const {
    if (!point.mesh) return glm::dvec3(1.0);
    const double chance = density(point, arrived, direction);
    if (!(chance > 0.0)) return glm::dvec3(0.0);
    const Frame frame(point.normal);
    return meshes_.reflection(point.facets).value(frame.into(-arrived), frame.into(direction)) / chance;
}

}  // namespace lumulus::reference
