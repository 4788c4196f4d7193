#include "surface/mesh/lamp_shading.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "surface/material/material.h"
#include "surface/mesh/normal_axes.h"

namespace lumulus::surface {

LampShading::LampShading(const MeshScene& scene, const std::vector<scene::Lamp>& lamps, const scene::Fog& fog,
                         const glm::dvec3& eye, std::vector<lamp::Cloud> clouds)
    : scene_(scene), haze_(fog, eye), clouds_(std::move(clouds)) {
    for (const scene::Lamp& lamp : lamps)
        if (lamp.shines()) beams_.emplace_back(lamp);
}

glm::dvec3 LampShading::at(const MeshPoint& point, const glm::dvec3& toEye, const material::EnergyTable& energy) const {
    const NormalAxes axes(point.normal);
    const glm::dvec3 view = axes.into(toEye);
    glm::dvec3 sum(0.0);
    for (const lamp::Beam& beam : beams_) {
        const glm::dvec3 way = beam.position() - point.position;
        const double distance = std::max(glm::length(way), beam.radius());
        const glm::dvec3 direction = way / distance;
        if (!(glm::dot(direction, point.faceNormal) > 0.0)) continue;
        const glm::dvec3 intensity = beam.intensity(-direction);
        if (intensity == glm::dvec3(0.0)) continue;
        material::Material material = point.material;
        // a lamp is a disc: its highlight is as much wider (Karis 2013)
        material.alpha = std::min(1.0, material.alpha + beam.radius() / (3.0 * distance));
        const glm::dvec3 share = material::Reflection(material, energy).reflected(view, axes.into(direction));
        if (share == glm::dvec3(0.0)) continue;
        const Ray ray{point.position, direction};
        if (scene_.meet(ray, distance - beam.radius(), point.instance, point.triangle)) continue;
        const double clear = clouds_.empty() ? 1.0 : std::exp(-clouds_.depth(ray, distance));
        const glm::dvec3 fog = haze_.isClear() ? glm::dvec3(1.0) : glm::exp(-haze_.depth(ray, distance));
        sum += intensity * share * fog * (clear / (distance * distance));
    }
    return sum;
}

lamp::Solids solidsOf(const MeshScene& scene) {
    lamp::Solids solids;
    solids.middle = scene.world.middle;
    solids.radius = static_cast<double>(scene.world.reach());
    solids.distance = [&scene](const Ray& ray, double metres) -> std::optional<double> {
        const auto met = scene.meet(ray, metres);
        return met ? std::optional(met->metres) : std::nullopt;
    };
    solids.meet = [&scene](const Ray& ray, double metres) -> std::optional<lamp::SolidMeeting> {
        const auto met = scene.meet(ray, metres);
        if (!met) return std::nullopt;
        const MeshPoint point = scene.at(met->hit, ray.direction);
        return lamp::SolidMeeting{met->metres, point.faceNormal,
                                  glm::min(point.material.albedo + point.material.reflectance, 1.0)};
    };
    return solids;
}

}  // namespace lumulus::surface
