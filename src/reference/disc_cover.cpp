#include "reference/disc_cover.h"

#include <algorithm>
#include <cmath>

namespace lumulus::reference {
namespace {

/// Parts of pixels that cross the rim are divided until they are this small against the disc's radius.
constexpr double finest = 1.0 / 64.0;
/// Parts that lie wholly in the disc are divided until they are nearly flat [radians].
constexpr double flat = 0.02;
/// Edges of a part may bulge beyond its corners.
constexpr double bulge = 1.2;

double angleBetween(const glm::dvec3& a, const glm::dvec3& b) {
    return 2.0 * std::atan2(glm::length(a - b), glm::length(a + b));
}

}  // namespace

glm::dvec2 DiscCover::Pixel::sample(Random& random) const {
    const double wanted = random.uniform() * squares.back().before;
    const auto square = std::ranges::lower_bound(squares, wanted, {}, &Square::before);
    const double x = random.uniform(), y = random.uniform();
    return square->corner + square->edge * glm::dvec2(x, y);
}

DiscCover::DiscCover(const Camera& camera, const glm::dvec3& sunDirection, double radius)
    : camera_(camera), sunDirection_(glm::normalize(sunDirection)), radius_(radius) {
    if (!(radius > 0.0)) return;
    for (int y = 0; y < camera.height; ++y)
        for (int x = 0; x < camera.width; ++x) {
            Pixel pixel;
            divide({x, y}, 1.0, pixel);
            if (pixel.squares.empty()) continue;
            const double reach = angleBetween(camera.ray(x, y).direction, camera.ray(x + 1, y + 1).direction);
            const double whole = solidAngle({x, y}, 1.0, reach > 0.05 ? 64 : 4);
            // all rays of an orthographic view have one direction, and pixels no solid angle
            const bool partial = pixel.crossed && whole > 0.0;
            pixel.share = partial ? std::min(1.0, pixel.squares.back().before / whole) : 1.0;
            pixels_.emplace(
                static_cast<std::size_t>(y) * static_cast<std::size_t>(camera.width) + static_cast<std::size_t>(x),
                std::move(pixel));
        }
}

const DiscCover::Pixel* DiscCover::find(int x, int y) const {
    const auto found = pixels_.find(static_cast<std::size_t>(y) * static_cast<std::size_t>(camera_.width) +
                                    static_cast<std::size_t>(x));
    return found == pixels_.end() ? nullptr : &found->second;
}

/// Adds the squares of a part of a pixel that lie in the disc.
void DiscCover::divide(const glm::dvec2& corner, double edge, Pixel& pixel) const {
    const glm::dvec3 middle = camera_.ray(corner.x + 0.5 * edge, corner.y + 0.5 * edge).direction;
    double reach = 0.0;
    for (int i = 0; i < 4; ++i)
        reach = std::max(
            reach, angleBetween(middle, camera_.ray(corner.x + (i & 1) * edge, corner.y + (i >> 1) * edge).direction));
    const double away = angleBetween(middle, sunDirection_);
    if (away > radius_ + bulge * reach) {
        pixel.crossed = true;
        return;
    }
    const bool rim = away > radius_ - bulge * reach;
    if (rim ? reach > finest * radius_ : reach > flat) {
        for (int i = 0; i < 4; ++i) divide(corner + 0.5 * edge * glm::dvec2(i & 1, i >> 1), 0.5 * edge, pixel);
        return;
    }
    if (away > radius_) {
        pixel.crossed = true;
        return;
    }
    const double before = pixel.squares.empty() ? 0.0 : pixel.squares.back().before;
    // an orthographic view has no solid angles: squares count by their area
    const double angle = reach > 0.0 ? solidAngle(corner, edge, 1) : edge * edge;
    pixel.squares.push_back({corner, edge, before + angle});
}

/// By flat quadrilaterals, `parts` along each side.
double DiscCover::solidAngle(const glm::dvec2& corner, double edge, int parts) const {
    const double step = edge / parts;
    double sum = 0.0;
    for (int i = 0; i < parts * parts; ++i) {
        const glm::dvec2 at = corner + step * glm::dvec2(i % parts, i / parts);
        const auto to = [&](int x, int y) { return camera_.ray(at.x + x * step, at.y + y * step).direction; };
        sum += 0.5 * glm::length(glm::cross(to(1, 1) - to(0, 0), to(0, 1) - to(1, 0)));
    }
    return sum;
}

}  // namespace lumulus::reference
