#include "frame/view_params.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lumulus::frame {

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
    view.halfExtent = glm::vec2(half * camera.width / camera.height * camera.pixelAspect, half);
    view.size = glm::ivec2(camera.width, camera.height);
    view.projection = projectionOf(camera.projection);
    return view;
}

}  // namespace lumulus::frame
