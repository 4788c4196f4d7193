#include "reference/ground.h"

namespace lumulus::reference {

std::optional<scene::Ground> groundOf(const scene::Scene& scene) {
    if (scene.ground || scene.sky.model != scene::SkyModel::atmosphere) return scene.ground;
    return scene::Ground{scene.sky.groundAlbedo, 0.0};
}

std::vector<scene::Surface> surfacesOf(const scene::Scene& scene) {
    std::vector<scene::Surface> surfaces = scene.surfaces;
    const std::optional<scene::Ground> ground = groundOf(scene);
    if (!ground) return surfaces;
    scene::Surface below;
    below.albedo = ground->albedo;
    below.emission = glm::dvec3(0.0);
    below.kind = scene::SurfaceKind::plane;
    below.position = {ground->foot.x, ground->height, ground->foot.y};
    below.normal = {0.0, 1.0, 0.0};
    if (scene.sky.model == scene::SkyModel::atmosphere) {
        below.kind = scene::SurfaceKind::sphere;
        below.position.y -= planetRadius;
        below.radius = planetRadius;
    }
    surfaces.push_back(below);
    return surfaces;
}

}  // namespace lumulus::reference
