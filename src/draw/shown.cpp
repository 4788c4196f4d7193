#include "draw/shown.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "shared/draw.h"

namespace lumulus::draw {

namespace {

/// A rectangle of the picture, in pixels.
struct Rectangle {
    glm::dvec2 low{1e300}, high{-1e300};
};

/// Of spheres of radius `reach` around the points; none where one of them may meet the plane of the eye.
std::optional<Rectangle> project(const Camera& camera, std::span<const glm::dvec3> points, double reach) {
    const bool parallel = camera.projection == scene::Projection::orthographic;
    const double halfHeight = parallel ? 0.5 * camera.orthographicHeight : camera.tanHalfFov;
    const glm::dvec2 half(halfHeight * camera.width / camera.height * (parallel ? 1.0 : camera.pixelAspect),
                          halfHeight);
    const glm::dmat3 toCamera = glm::transpose(camera.axes);
    Rectangle plane;
    for (const glm::dvec3& point : points) {
        const glm::dvec3 p = toCamera * (point - camera.position);
        if (!parallel && !(p.z > 2.0 * reach)) return std::nullopt;
        const glm::dvec2 at = parallel ? glm::dvec2(p) : glm::dvec2(p) / p.z - camera.middle;
        // (x ± r) / (z ± r) differs from x / z by at most r (1 + |x / z|) / (z − r)
        const glm::dvec2 beside =
            parallel ? glm::dvec2(reach) : reach * (1.0 + glm::abs(glm::dvec2(p) / p.z)) / (p.z - reach);
        plane.low = glm::min(plane.low, at - beside);
        plane.high = glm::max(plane.high, at + beside);
    }
    const glm::dvec2 size(camera.width, camera.height);
    return Rectangle{0.5 * size * (1.0 + glm::dvec2(plane.low.x / half.x, -plane.high.y / half.y)),
                     0.5 * size * (1.0 + glm::dvec2(plane.high.x / half.x, -plane.low.y / half.y))};
}

/// Whether all of it is behind the eye.
bool isBehind(const Camera& camera, std::span<const glm::dvec3> points, double reach) {
    return std::ranges::all_of(
        points, [&](const glm::dvec3& point) { return glm::dot(camera.axes[2], point - camera.position) < -reach; });
}

/// From the start of a tile of pixels to the end of another, with a pixel to spare.
glm::dvec2 wholeTiles(double low, double high) {
    constexpr double edge = shared::TILE_EDGE;
    return edge * glm::dvec2(std::floor((low - 1.0) / edge), std::ceil((high + 1.0) / edge));
}

}  // namespace

Tile shownPart(const Camera& camera, const Bounds& cloud, double reach, const Tile& within) {
    if (camera.projection == scene::Projection::panorama) return within;
    const auto corners = cloud.corners();
    const auto points = cloud.outline.empty() ? std::span(corners) : std::span(cloud.outline);
    if (isBehind(camera, points, reach)) return {within.x, within.y, 0, 0};
    const auto seen = project(camera, points, reach);
    if (!seen) return within;
    const auto cut = [](const glm::dvec2& wanted, int first, int count) {
        const double begin = std::clamp(wanted.x, static_cast<double>(first), static_cast<double>(first + count));
        const double end = std::clamp(wanted.y, begin, static_cast<double>(first + count));
        return glm::ivec2(static_cast<int>(begin), static_cast<int>(end - begin));
    };
    const glm::ivec2 x = cut(wholeTiles(seen->low.x, seen->high.x), within.x, within.width);
    const glm::ivec2 y = cut(wholeTiles(seen->low.y, seen->high.y), within.y, within.height);
    return x[1] > 0 && y[1] > 0 ? Tile{x[0], y[0], x[1], y[1]} : Tile{within.x, within.y, 0, 0};
}

}  // namespace lumulus::draw
