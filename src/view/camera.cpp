#include "view/camera.h"

#include <algorithm>
#include <glm/gtc/constants.hpp>
#include <span>

#include "base/error.h"

namespace lumulus {
namespace {

constexpr double filledShare = 0.9;

/// From the target to a camera that nobody placed.
glm::dvec3 defaultDirection() {
    const double azimuth = glm::radians(20.0), elevation = glm::radians(-5.0);
    return {std::sin(azimuth) * std::cos(elevation), std::sin(elevation), std::cos(azimuth) * std::cos(elevation)};
}

/// Columns right, up, forward.
glm::dmat3 axesOf(const glm::dvec3& forward, glm::dvec3 up) {
    up = glm::normalize(up);
    // sine of the angle between them: below this, "right" would be made of rounding
    constexpr double parallel = 1e-6;
    const glm::dvec3 north(0.0, 0.0, -1.0);
    if (glm::length(glm::cross(forward, up)) < parallel)
        up = std::abs(forward.z) < 0.9 ? north : glm::dvec3(0.0, 1.0, 0.0);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, up));
    return {right, glm::cross(right, forward), forward};
}

/// A panorama is level whatever it looks at.
glm::dmat3 panoramaAxes(const glm::dvec3& forward, const glm::dvec3& up) {
    const glm::dvec3 right = axesOf(forward, up)[0];
    const glm::dvec3 upright = glm::normalize(up);
    return {right, upright, glm::normalize(glm::cross(upright, right))};
}

/// The smallest distance from the target at which the whole cloud is within the filled share of the picture and in
/// front.
double framingDistance(const Camera& camera, const glm::dvec3& target, const Bounds& cloud) {
    const double tanY = filledShare * camera.tanHalfFov;
    const double tanX = tanY * camera.width / camera.height;
    const bool perspective = camera.projection == scene::Projection::perspective;
    const auto corners = cloud.corners();
    const std::span<const glm::dvec3> points = cloud.outline.empty() ? std::span(corners) : std::span(cloud.outline);
    double distance = 0.0;
    for (const glm::dvec3& point : points) {
        // across, up and (behind the target) away from the camera
        const glm::dvec3 p = glm::transpose(camera.axes) * (point - target);
        const double fit = std::max(std::abs(p.x) / tanX, std::abs(p.y) / tanY);
        distance = std::max(distance, perspective ? fit - p.z : std::max(fit, -p.z));
    }
    return distance;
}

}  // namespace

Ray Camera::ray(double px, double py) const {
    const double x = 2.0 * px / width - 1.0;
    const double y = 1.0 - 2.0 * py / height;
    const double aspect = static_cast<double>(width) / height;
    if (projection == scene::Projection::panorama) {
        const double azimuth = x * glm::pi<double>(), elevation = y * glm::half_pi<double>();
        const double across = std::cos(elevation);
        return {position,
                axes * glm::dvec3(across * std::sin(azimuth), std::sin(elevation), across * std::cos(azimuth))};
    }
    if (projection == scene::Projection::orthographic) {
        const double half = 0.5 * orthographicHeight;
        return {position + axes * glm::dvec3(x * half * aspect, y * half, 0.0), axes[2]};
    }
    const glm::dvec2 half(tanHalfFov * aspect * pixelAspect, tanHalfFov);
    return {position, glm::normalize(axes * glm::dvec3(middle + glm::dvec2(x, y) * half, 1.0))};
}

Camera makeCamera(const scene::Camera& camera, const scene::Image& image, const Bounds& cloud) {
    Camera result;
    result.projection = camera.projection;
    result.width = image.width;
    result.height = image.height;
    result.tanHalfFov = std::tan(0.5 * glm::radians(camera.verticalFov));
    const glm::dvec3 target = camera.target.value_or(cloud.centre);
    glm::dvec3 forward = -defaultDirection();
    if (camera.position) {
        if (*camera.position == target) {
            throw InputError("the camera stands in its target", "camera.position",
                             "move one of them, or leave out both");
        }
        forward = glm::normalize(target - *camera.position);
    }
    result.axes = axesOf(forward, camera.up);
    result.position = camera.position ? *camera.position : target - forward * framingDistance(result, target, cloud);
    result.orthographicHeight = 2.0 * result.tanHalfFov * glm::distance(result.position, target);
    if (camera.projection == scene::Projection::panorama) result.axes = panoramaAxes(forward, camera.up);
    return result;
}

}  // namespace lumulus
