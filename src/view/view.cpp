#include "view/view.h"

#include <cmath>

#include "base/error.h"

namespace lumulus {
namespace {

void applyOrientation(Camera& camera, const glm::dquat& orientation) {
    const double length = glm::length(orientation);
    if (!(length > 1e-9) || !std::isfinite(length))
        throw InputError("the orientation must have a length", "camera.orientation", "give a quaternion [w, x, y, z]");
    const glm::dmat3 turn = glm::mat3_cast(orientation / length);
    camera.axes = {turn[0], turn[1], -turn[2]};
}

void applyFrustum(Camera& camera, const Frustum& frustum) {
    if (camera.projection != scene::Projection::perspective)
        throw InputError("a frustum is for perspective views", "camera.frustum", "leave it out");
    const double width = frustum.right - frustum.left, height = frustum.top - frustum.bottom;
    if (!(width > 0.0) || !(height > 0.0))
        throw InputError("the frustum is empty", "camera.frustum", "give left < right and bottom < top");
    camera.tanHalfFov = 0.5 * height;
    camera.pixelAspect = (width / camera.width) / (height / camera.height);
    camera.middle = {0.5 * (frustum.left + frustum.right), 0.5 * (frustum.bottom + frustum.top)};
}

}  // namespace

Camera makeCamera(const View& view, const Bounds& cloud) {
    Camera camera = makeCamera(view.camera, view.image, cloud);
    if (view.orientation) applyOrientation(camera, *view.orientation);
    if (view.frustum) applyFrustum(camera, *view.frustum);
    return camera;
}

Camera windowCamera(const Camera& camera, const Tile& window) {
    if (window == Tile{0, 0, camera.width, camera.height}) return camera;
    if (camera.projection == scene::Projection::panorama)
        throw InputError("a part of a panorama has no camera of its own", "camera.projection",
                         "give the whole panorama, whose data window is its display window");
    const bool perspective = camera.projection == scene::Projection::perspective;
    const double half = perspective ? camera.tanHalfFov : 0.5 * camera.orthographicHeight;
    const double across = half * camera.width / camera.height * (perspective ? camera.pixelAspect : 1.0);
    // the window's middle, from that of the picture
    const glm::dvec2 shift((2.0 * window.x + window.width) / camera.width - 1.0,
                           1.0 - (2.0 * window.y + window.height) / camera.height);
    const glm::dvec2 middle = shift * glm::dvec2(across, half);
    const double share = static_cast<double>(window.height) / camera.height;
    Camera result = camera;
    result.width = window.width;
    result.height = window.height;
    if (perspective) {
        result.tanHalfFov *= share;
        result.middle += middle;
    } else {
        result.orthographicHeight *= share;
        result.position += camera.axes * glm::dvec3(middle, 0.0);
    }
    return result;
}

Tile drawnTile(const View& view) {
    const Tile tile = view.tile.value_or(Tile{0, 0, view.image.width, view.image.height});
    const bool within = tile.x >= 0 && tile.y >= 0 && tile.width > 0 && tile.height > 0 &&
                        tile.x <= view.image.width - tile.width && tile.y <= view.image.height - tile.height;
    if (!within) throw InputError("the tile is not within the picture", "tile", "give [x, y, width, height] in pixels");
    return tile;
}

}  // namespace lumulus
