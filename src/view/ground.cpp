#include "view/ground.h"

#include <algorithm>

#include "scene/fog_bounds.h"
#include "view/camera.h"

namespace lumulus {

scene::Scene groundedScene(const scene::Scene& scene, const Bounds& clouds) {
    scene::Scene grounded = scene;
    if (!scene.sky.groundBelowClouds) return grounded;
    double lowest = makeCamera(scene.camera, scene.image, clouds).position.y;
    for (const glm::dvec3& corner : clouds.corners()) lowest = std::min(lowest, corner.y);
    const double away = std::clamp(3.0 * clouds.radius(), 600.0, 2000.0);
    constexpr double highest = 20e3;  // of clouds that have heights above the sea
    const bool above = lowest >= away && lowest <= highest;
    grounded.ground =
        scene::Ground{scene.sky.groundAlbedo, above ? 0.0 : lowest - away, {clouds.centre.x, clouds.centre.z}};
    for (scene::FogMedium& medium : grounded.fog.media) scene::endAtGround(medium, grounded.ground->height);
    return grounded;
}

}  // namespace lumulus
