#include "frame/sun_cover.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace lumulus::frame {

namespace {

using std::numbers::pi;

/// Strips of the disc within one row of pixels.
constexpr int strips = 64;
constexpr double endless = std::numeric_limits<double>::infinity();

/// Part of an axis, in its own unit.
struct Span {
    double begin = 0.0, end = 0.0;
    double length() const { return std::max(0.0, end - begin); }
};

Span overlap(const Span& a, const Span& b) {
    return {std::max(a.begin, b.begin), std::min(a.end, b.end)};
}

/// Where a x² + 2 b x + c ≥ 0 holds: between the roots for a < 0. For a ≥ 0 it holds outside of them, and `positive`
/// chooses the side.
std::optional<Span> solve(double a, double b, double c, bool positive) {
    const double discriminant = b * b - a * c;
    if (a < 0.0) {
        if (discriminant <= 0.0) return std::nullopt;
        // the root that does not cancel first
        const double q = -(b + std::copysign(std::sqrt(discriminant), b));
        const double first = q / a, second = q != 0.0 ? c / q : 0.0;
        return Span{std::min(first, second), std::max(first, second)};
    }
    if (discriminant <= 0.0 || a == 0.0) return Span{-endless, endless};
    const double root = std::sqrt(discriminant);
    return positive ? Span{(-b + root) / a, endless} : Span{-endless, (-b - root) / a};
}

/// The disc as an equirectangular panorama has it: rows in elevation, columns in azimuth.
class Panorama {
  public:
    Panorama(const Camera& camera, const glm::dvec3& toSun, double radius)
        : size_(camera.width, camera.height),
          radius_(radius),
          azimuth_(std::atan2(toSun.x, toSun.z)),
          elevation_(std::asin(std::clamp(toSun.y, -1.0, 1.0))) {}

    Span rowSpan(int y) const { return {elevationOf(y + 1), elevationOf(y)}; }
    /// Of the whole disc along the axis of rows.
    Span extent() const { return {elevation_ - radius_, elevation_ + radius_}; }

    /// Solid angle of the disc within a strip, added to the pixels of its row by `add(x, solid angle)`.
    template <class Add>
    void addStrip(double elevation, double height, const Add& add) const {
        const double half = halfWidth(elevation) / (2.0 * pi) * size_.x;
        if (half <= 0.0) return;
        const double middle = 0.5 * (azimuth_ / pi + 1.0) * size_.x;
        const double each = std::cos(elevation) * height * 2.0 * pi / size_.x;
        for (int x = static_cast<int>(std::floor(middle - half)); x < middle + half; ++x) {
            const Span inside = overlap({middle - half, middle + half}, {static_cast<double>(x), x + 1.0});
            add((x % size_.x + size_.x) % size_.x, each * inside.length());
        }
    }

    double pixelAngle(int /*x*/, int y) const {
        const Span row = rowSpan(y);
        return 2.0 * pi / size_.x * (std::sin(row.end) - std::sin(row.begin));
    }

  private:
    double elevationOf(int y) const { return pi * (0.5 - static_cast<double>(y) / size_.y); }

    /// Azimuths to each side of the middle that lie in the disc (law of haversines).
    double halfWidth(double elevation) const {
        const auto squared = [](double x) { return x * x; };
        const double inside = squared(std::sin(0.5 * radius_)) - squared(std::sin(0.5 * (elevation - elevation_)));
        const double cosines = std::cos(elevation) * std::cos(elevation_);
        if (inside <= 0.0) return 0.0;
        return cosines > inside ? 2.0 * std::asin(std::sqrt(inside / cosines)) : pi;
    }

    glm::ivec2 size_;
    double radius_, azimuth_, elevation_;
};

/// The disc as a conic in the plane one metre before a perspective camera: rows up, columns to the right.
class Plane {
  public:
    Plane(const Camera& camera, const glm::dvec3& toSun, double radius)
        : size_(camera.width, camera.height),
          middle_(camera.middle),
          half_(camera.tanHalfFov * camera.width / camera.height * camera.pixelAspect, camera.tanHalfFov),
          sun_(toSun),
          cosine_(std::cos(radius)) {}

    Span rowSpan(int y) const { return {heightOf(y + 1), heightOf(y)}; }

    /// Without an end where the disc reaches the plane's horizon.
    Span extent() const {
        const double least = cosine_ * cosine_ - sun_.x * sun_.x;
        if (least <= 0.0) return {-endless, endless};
        return solve(sun_.y * sun_.y - least, sun_.y * sun_.z, sun_.z * sun_.z - least, sun_.y > 0.0).value_or(Span{});
    }

    template <class Add>
    void addStrip(double up, double height, const Add& add) const {
        const double along = up * sun_.y + sun_.z, away = 1.0 + up * up, c2 = cosine_ * cosine_;
        const auto found = solve(sun_.x * sun_.x - c2, sun_.x * along, along * along - c2 * away, sun_.x > 0.0);
        if (!found) return;
        const Span seen = overlap(*found, {acrossOf(0), acrossOf(size_.x)});
        // the other half of the double cone lies behind the eye
        if (!(seen.length() > 0.0) || sun_.x * 0.5 * (seen.begin + seen.end) + along <= 0.0) return;
        const auto pixelOf = [&](double x) {
            return std::clamp(static_cast<int>(std::floor(((x - middle_.x) / half_.x + 1.0) * 0.5 * size_.x)), 0,
                              size_.x - 1);
        };
        // ∫ dx / (1 + x² + y²)^3/2
        const auto angle = [&](double x) { return x / (away * std::sqrt(away + x * x)); };
        for (int x = pixelOf(seen.begin); x <= pixelOf(seen.end); ++x) {
            const Span inside = overlap(seen, {acrossOf(x), acrossOf(x + 1)});
            if (inside.length() > 0.0) add(x, height * (angle(inside.end) - angle(inside.begin)));
        }
    }

    double pixelAngle(int x, int y) const {
        const auto corner = [](double a, double b) { return std::atan(a * b / std::sqrt(1.0 + a * a + b * b)); };
        const Span row = rowSpan(y);
        const double left = acrossOf(x), right = acrossOf(x + 1);
        return corner(right, row.end) - corner(left, row.end) - corner(right, row.begin) + corner(left, row.begin);
    }

  private:
    double heightOf(int y) const { return middle_.y + (1.0 - 2.0 * y / static_cast<double>(size_.y)) * half_.y; }
    double acrossOf(int x) const { return middle_.x + (2.0 * x / static_cast<double>(size_.x) - 1.0) * half_.x; }

    glm::ivec2 size_;
    glm::dvec2 middle_, half_;
    glm::dvec3 sun_;
    double cosine_;
};

/// Calls `add(place, height)` for strips of a part of the disc, which become thin towards its ends: there its width
/// changes fast.
template <class Add>
void forStrips(const Span& disc, const Span& part, const Add& add) {
    if (!std::isfinite(disc.length())) {
        const double height = part.length() / strips;
        for (int i = 0; i < strips; ++i) add(part.begin + (i + 0.5) * height, height);
        return;
    }
    const double middle = 0.5 * (disc.begin + disc.end), half = 0.5 * (disc.end - disc.begin);
    const double first = std::asin(std::clamp((part.begin - middle) / half, -1.0, 1.0));
    const double last = std::asin(std::clamp((part.end - middle) / half, -1.0, 1.0));
    const double step = (last - first) / strips;
    for (int i = 0; i < strips; ++i) {
        const double at = first + (i + 0.5) * step;
        add(middle + half * std::sin(at), half * std::cos(at) * step);
    }
}

/// The covered pixels of one row.
template <class Projection>
std::vector<CoveredPixel> coveredRow(const Projection& projection, const Span& disc, const Tile& tile, int y) {
    const Span part = overlap(disc, projection.rowSpan(y));
    if (!(part.length() > 0.0)) return {};
    std::vector<double> angles(static_cast<std::size_t>(tile.width), 0.0);
    const auto add = [&](int x, double angle) {
        if (x >= tile.x && x < tile.x + tile.width) angles[static_cast<std::size_t>(x - tile.x)] += angle;
    };
    forStrips(disc, part, [&](double place, double height) { projection.addStrip(place, height, add); });
    std::vector<CoveredPixel> pixels;
    for (std::size_t i = 0; i < angles.size(); ++i) {
        if (!(angles[i] > 0.0)) continue;
        const int x = tile.x + static_cast<int>(i);
        pixels.push_back({{x, y}, std::min(1.0, angles[i] / projection.pixelAngle(x, y))});
    }
    return pixels;
}

template <class Projection>
std::vector<CoveredPixel> covered(const Projection& projection, const Tile& tile) {
    const Span disc = projection.extent();
    std::vector<std::vector<CoveredPixel>> found(static_cast<std::size_t>(tile.height));
    tbb::parallel_for(0, tile.height, [&](int row) {
        found[static_cast<std::size_t>(row)] = coveredRow(projection, disc, tile, tile.y + row);
    });
    std::vector<CoveredPixel> pixels;
    for (const auto& row : found) pixels.insert(pixels.end(), row.begin(), row.end());
    return pixels;
}

std::vector<CoveredPixel> wholeTile(const Tile& tile) {
    std::vector<CoveredPixel> pixels;
    for (int y = tile.y; y < tile.y + tile.height; ++y)
        for (int x = tile.x; x < tile.x + tile.width; ++x) pixels.push_back({{x, y}, 1.0});
    return pixels;
}

}  // namespace

std::vector<CoveredPixel> sunCover(const Camera& camera, const Tile& tile, const glm::dvec3& directionTo,
                                   double radius) {
    if (!(radius > 0.0)) return {};
    const glm::dvec3 toSun = glm::transpose(camera.axes) * glm::normalize(directionTo);
    switch (camera.projection) {
        case scene::Projection::panorama:
            return covered(Panorama(camera, toSun, radius), tile);
        case scene::Projection::orthographic:
            return std::atan2(std::hypot(toSun.x, toSun.y), toSun.z) <= radius ? wholeTile(tile)
                                                                               : std::vector<CoveredPixel>{};
        case scene::Projection::perspective:
            break;
    }
    return covered(Plane(camera, toSun, radius), tile);
}

}  // namespace lumulus::frame
