#include "lamp/picture_plane.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lumulus::lamp {

std::optional<glm::dvec2> PicturePlane::placeOf(const glm::dvec3& direction, double margin) const {
    const glm::dvec3 v = glm::transpose(camera_.axes) * direction;
    glm::dvec2 place;  // from −1 to 1, upwards
    if (camera_.projection == scene::Projection::panorama) {
        place = {std::atan2(v.x, v.z) / std::numbers::pi,
                 2.0 * std::asin(std::clamp(v.y, -1.0, 1.0)) / std::numbers::pi};
    } else {
        if (!(v.z > 0.0)) return std::nullopt;
        const double across = camera_.tanHalfFov * camera_.width / camera_.height * camera_.pixelAspect;
        place = (glm::dvec2(v) / v.z - camera_.middle) / glm::dvec2(across, camera_.tanHalfFov);
    }
    const glm::dvec2 pixel(0.5 * (place.x + 1.0) * camera_.width, 0.5 * (1.0 - place.y) * camera_.height);
    const glm::dvec2 size(camera_.width, camera_.height);
    const bool inside =
        glm::all(glm::greaterThanEqual(pixel, glm::dvec2(-margin))) && glm::all(glm::lessThan(pixel, size + margin));
    if (!inside) return std::nullopt;
    return pixel;
}

double PicturePlane::solidAngle(const glm::dvec2& corner, double edge) const {
    const glm::dvec2 middle = corner + 0.5 * edge;
    constexpr double step = 0.5;
    const auto at = [&](double x, double y) { return camera_.ray(middle.x + x, middle.y + y).direction; };
    const glm::dvec3 across = at(step, 0.0) - at(-step, 0.0), down = at(0.0, step) - at(0.0, -step);
    return glm::length(glm::cross(across, down)) * edge * edge;
}

}  // namespace lumulus::lamp
