#include "service/render/views.h"

#include "base/error.h"
#include "service/values/request_error.h"

namespace lumulus::service {

namespace {

View viewOf(const ViewRequest& request, const View& sceneView) {
    View view = sceneView;
    const CameraRequest& camera = request.camera;
    if (camera.position) view.camera.position = camera.position;
    if (camera.target) view.camera.target = camera.target;
    view.camera.up = camera.up.value_or(view.camera.up);
    view.camera.verticalFov = camera.verticalFov.value_or(view.camera.verticalFov);
    view.camera.projection = camera.projection.value_or(view.camera.projection);
    view.orientation = camera.orientation;
    view.frustum = camera.frustum;
    // the orientation says where it looks; the target only must not be the position
    if (camera.orientation) view.camera.target = *view.camera.position - glm::dvec3(0.0, 0.0, 1.0);
    view.image.width = request.width.value_or(view.image.width);
    view.image.height = request.height.value_or(view.image.height);
    view.tile = request.tile;
    return view;
}

}  // namespace

std::vector<View> viewsOf(const std::vector<ViewRequest>& requests, const View& sceneView, const Bounds& bounds,
                          std::uint64_t mostPixels) {
    std::vector<View> views;
    try {
        for (const ViewRequest& request : requests) {
            views.push_back(viewOf(request, sceneView));
            drawnTile(views.back());
            makeCamera(views.back(), bounds);
        }
    } catch (const InputError& e) {
        throw RequestError("bad_request", e.what());
    }
    if (pixelsOf(views) > mostPixels)
        throw RequestError("too_large", "a frame may hold " + std::to_string(mostPixels) + " pixels here");
    return views;
}

std::uint64_t pixelsOf(const std::vector<View>& views) {
    std::uint64_t pixels = 0;
    for (const View& view : views) {
        const Tile tile = drawnTile(view);
        pixels += static_cast<std::uint64_t>(tile.width) * static_cast<std::uint64_t>(tile.height);
    }
    return pixels;
}

}  // namespace lumulus::service
