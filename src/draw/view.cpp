#include "draw/view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lumulus::draw {

namespace {

/// Beyond it a cloud is a few pixels.
constexpr double maxRaysAcross = 4.0;

int projectionOf(scene::Projection projection) {
    switch (projection) {
        case scene::Projection::orthographic:
            return shared::PROJECTION_ORTHOGRAPHIC;
        case scene::Projection::panorama:
            return shared::PROJECTION_PANORAMA;
        case scene::Projection::perspective:
            break;
    }
    return shared::PROJECTION_PERSPECTIVE;
}

}  // namespace

double pixelLength(const Camera& camera, const glm::dvec3& place) {
    if (camera.projection == scene::Projection::orthographic) return camera.orthographicHeight / camera.height;
    const bool panorama = camera.projection == scene::Projection::panorama;
    const double angle = (panorama ? std::numbers::pi : 2.0 * camera.tanHalfFov) / camera.height;
    return angle * glm::length(place - camera.position);
}

int raysAcross(double voxelPixels) {
    return static_cast<int>(std::ceil(std::clamp(1.0 / voxelPixels, 1.0, maxRaysAcross)));
}

shared::ViewParams viewParams(const Camera& camera) {
    shared::ViewParams view{};
    view.right = glm::vec3(camera.axes[0]);
    view.up = glm::vec3(camera.axes[1]);
    view.forward = glm::vec3(camera.axes * glm::dvec3(camera.middle, 1.0));
    const double half =
        camera.projection == scene::Projection::orthographic ? 0.5 * camera.orthographicHeight : camera.tanHalfFov;
    view.halfExtent = glm::vec2(half * camera.width / camera.height * camera.stretch, half);
    view.size = glm::ivec2(camera.width, camera.height);
    view.projection = projectionOf(camera.projection);
    return view;
}

shared::LightParams lightParams(const scene::Sun& sun, const scene::Sky& sky, const glm::dvec3& albedo,
                                const phase::ScatteringTables& tables) {
    shared::LightParams light{};
    const double radius = 0.5 * sun.angularDiameter * std::numbers::pi / 180.0;
    const double sine = std::sin(radius);
    light.sunTravel = glm::vec3(-sun.directionTo);
    light.sunIrradiance = glm::vec3(sun.irradiance);
    light.sunDisc = sine > 0.0 ? glm::vec3(sun.irradiance / (std::numbers::pi * sine * sine)) : glm::vec3(0.0F);
    light.sunCone = sine > 0.0 ? static_cast<float>(2.0 * std::pow(std::sin(0.5 * radius), 2)) : -1.0F;
    light.skyRadiance = glm::vec3(sky.radiance);
    light.albedo = glm::vec3(albedo);
    light.decay = glm::vec3(1.0 - static_cast<double>(tables.forwardFraction) * albedo);
    light.turnShare = tables.turnFraction;
    light.angleScale = tables.angleScale;
    light.tauMaximum = tables.tauMaximum;
    return light;
}

}  // namespace lumulus::draw
