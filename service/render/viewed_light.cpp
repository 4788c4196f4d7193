#include "service/render/viewed_light.h"

#include "view/camera.h"

namespace lumulus::service {

ViewedLight::Eye ViewedLight::eyeOf(const View& view, const Bounds& clouds, double time) {
    const Camera camera = makeCamera(view, clouds);
    const bool parallel = camera.projection == scene::Projection::orthographic;
    return {camera.position, parallel ? camera.axes[2] : glm::dvec3(0.0), time};
}

std::uint64_t ViewedLight::missing(const std::vector<View>& views, const Bounds& clouds, double time) const {
    std::uint64_t count = 0;
    std::optional<Eye> last = eye_;
    for (const View& view : views) {
        const Eye eye = eyeOf(view, clouds, time);
        count += last != eye ? 1U : 0U;
        last = eye;
    }
    return count;
}

void ViewedLight::drawn(const std::vector<View>& views, const Bounds& clouds, double time) {
    if (!views.empty()) eye_ = eyeOf(views.back(), clouds, time);
}

}  // namespace lumulus::service
