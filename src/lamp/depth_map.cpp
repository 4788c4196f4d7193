#include "lamp/depth_map.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace lumulus::lamp {

namespace {

using std::numbers::pi;

constexpr std::size_t slices = 64;
/// First, coarser slices by which the range with density is found.
constexpr std::size_t firstSlices = 24;

double versine(double angle) {
    return 2.0 * std::sin(0.5 * angle) * std::sin(0.5 * angle);
}

glm::dmat3 axesAround(const glm::dvec3& axis) {
    const glm::dvec3 across = glm::normalize(
        glm::cross(axis, std::abs(axis.y) < 0.9 ? glm::dvec3(0.0, 1.0, 0.0) : glm::dvec3(1.0, 0.0, 0.0)));
    return {across, glm::cross(axis, across), axis};
}

/// Direction at a place of the map, whose disc has the radius 1.
glm::dvec3 directionAt(const glm::dmat3& axes, double widest, const glm::dvec2& place) {
    const double away = std::min(2.0, glm::dot(place, place) * widest), ahead = 1.0 - away;
    const double across = std::sqrt(std::max(0.0, away * (2.0 - away))), length = glm::length(place);
    const glm::dvec2 around = length > 0.0 ? place / length : glm::dvec2(0.0);
    return glm::normalize(axes * glm::dvec3(across * around, ahead));
}

/// A part of a ray in slices.
struct Slices {
    double begin = 0.0, end = 0.0;
    std::vector<double> depths;  ///< of each

    /// Between the first and the last with density.
    void shrink() {
        const double each = (end - begin) / static_cast<double>(depths.size());
        const auto full = [](double depth) { return depth > 0.0; };
        const auto first = std::ranges::find_if(depths, full) - depths.begin();
        const auto after = std::find_if(depths.rbegin(), depths.rend(), full).base() - depths.begin();
        end = begin + each * static_cast<double>(after);
        begin += each * static_cast<double>(std::min(first, after));
    }
};

void findDepths(const Clouds& clouds, const Ray& ray, const std::vector<CloudPart>& parts, std::size_t count,
                Slices& of) {
    of.depths.assign(count, 0.0);
    const double each = (of.end - of.begin) / static_cast<double>(count);
    for (const CloudPart& part : parts)
        for (std::size_t i = 0; i < count; ++i) {
            const double from = of.begin + each * static_cast<double>(i);
            if (from + each <= part.begin || from >= part.end) continue;
            of.depths[i] += clouds.depthOf(part.cloud, ray, from, from + each);
        }
}

}  // namespace

Cone coneToSphere(const glm::dvec3& middle, double radius, const glm::dvec3& point, const Cone& cone) {
    const glm::dvec3 way = middle - point;
    const double distance = glm::length(way);
    if (!(distance > 1.02 * radius)) return cone;
    const Cone all{way / distance, std::asin(std::min(1.0, radius / distance))};
    const double between = 2.0 * std::asin(std::min(1.0, 0.5 * glm::length(all.axis - cone.axis)));
    if (between >= all.angle + cone.angle) return {cone.axis, 0.0};
    return all.angle < cone.angle ? all : cone;
}

DepthMap::DepthMap(const Clouds& clouds, const glm::dvec3& point, const Cone& cone, int edge, const Check& check)
    : edge_(edge) {
    if (clouds.empty() || !(cone.angle > 0.0)) return;
    begin(cone);
    for (Side& side : sides_) fill(clouds, point, side, check);
    const auto isClear = [](const Side& side) {
        return std::ranges::all_of(side.depths, [](float depth) { return depth == 0.0F; });
    };
    if (std::ranges::all_of(sides_, isClear)) sides_.clear();
}

DepthMap::DepthMap(const Solids& solids, const glm::dvec3& point, const Cone& cone, int edge, const Check& check)
    : edge_(edge) {
    if (!(cone.angle > 0.0)) return;
    begin(cone);
    const auto count = static_cast<std::size_t>(edge_) * static_cast<std::size_t>(edge_);
    constexpr float nothing = std::numeric_limits<float>::max();
    bool meets = false;
    for (Side& side : sides_) {
        side.ranges.assign(2 * count, nothing);
        forEachTexel(side, point, check, [&](std::size_t texel, const Ray& ray) {
            if (const auto met = solids.distance(ray, 1e9)) side.ranges[2 * texel] = static_cast<float>(*met);
        });
        meets = meets || std::ranges::any_of(side.ranges, [](float distance) { return distance < nothing; });
    }
    if (!meets) sides_.clear();
}

void DepthMap::begin(const Cone& cone) {
    const double half = 0.5 * pi;
    sides_.push_back({axesAround(cone.axis), versine(std::min(cone.angle, half)), {}, {}});
    if (cone.angle > half) sides_.push_back({axesAround(-cone.axis), 1.0, {}, {}});
}

template <class FillTexel>
void DepthMap::forEachTexel(const Side& side, const glm::dvec3& point, const Check& check,
                            const FillTexel& fill) const {
    const auto across = static_cast<std::size_t>(edge_);
    // the map goes on for a texel and a half beyond the cone, so that its rim is between texels
    const double most = 1.0 + 3.0 / edge_;
    tbb::parallel_for(std::size_t{0}, across, [&](std::size_t row) {
        check();
        for (std::size_t column = 0; column < across; ++column) {
            const glm::dvec2 place =
                most * ((glm::dvec2(column, row) + 0.5) * (2.0 / static_cast<double>(edge_)) - 1.0);
            if (glm::length(place) > most + 1.5 / edge_) continue;
            fill(row * across + column, Ray{point, directionAt(side.axes, side.widest, place)});
        }
    });
}

void DepthMap::fill(const Clouds& clouds, const glm::dvec3& point, Side& side, const Check& check) const {
    const auto count = static_cast<std::size_t>(edge_) * static_cast<std::size_t>(edge_);
    side.ranges.assign(2 * count, 0.0F);
    side.depths.assign((slices + 1) * count, 0.0F);
    forEachTexel(side, point, check, [&](std::size_t texel, const Ray& ray) {
        thread_local std::vector<CloudPart> parts;  // no allocation a ray
        thread_local Slices found;
        parts.clear();
        clouds.addParts(ray, std::numeric_limits<double>::infinity(), parts);
        if (parts.empty()) return;
        found.begin = std::ranges::min(parts, {}, &CloudPart::begin).begin;
        found.end = std::ranges::max(parts, {}, &CloudPart::end).end;
        findDepths(clouds, ray, parts, firstSlices, found);
        found.shrink();
        if (!(found.begin < found.end)) return;
        findDepths(clouds, ray, parts, slices, found);
        side.ranges[2 * texel] = static_cast<float>(found.begin);
        side.ranges[2 * texel + 1] = static_cast<float>(found.end);
        double sum = 0.0;
        for (std::size_t i = 0; i < slices; ++i)
            side.depths[(slices + 1) * texel + i + 1] = static_cast<float>(sum += found.depths[i]);
    });
}

double DepthMap::passed(const Side& side, std::size_t texel, double distance) const {
    const auto begin = static_cast<double>(side.ranges[2 * texel]),
               end = static_cast<double>(side.ranges[2 * texel + 1]);
    if (side.depths.empty()) return distance <= begin ? 1.0 : 0.0;
    if (distance <= begin || !(begin < end)) return 1.0;
    const double place = std::min(1.0, (distance - begin) / (end - begin)) * static_cast<double>(slices);
    const auto slice = std::min(static_cast<std::size_t>(place), slices - 1);
    const float* at = &side.depths[(slices + 1) * texel + slice];
    const auto near = static_cast<double>(at[0]), far = static_cast<double>(at[1]);
    return std::exp(-(near + (place - static_cast<double>(slice)) * (far - near)));
}

double DepthMap::transmittance(const glm::dvec3& direction, double distance) const {
    if (sides_.empty()) return 1.0;
    const Side* side = &sides_.front();
    if (sides_.size() > 1 && glm::dot(direction, side->axes[2]) < 0.0) side = &sides_.back();
    const glm::dvec3 local = glm::transpose(side->axes) * direction;
    const double away = 1.0 - local.z, edge = static_cast<double>(edge_), most = 1.0 + 3.0 / edge;
    const double radius = std::sqrt(away / side->widest), across = std::hypot(local.x, local.y);
    if (radius > most) return 1.0;
    const glm::dvec2 place = across > 0.0 ? radius / across * glm::dvec2(local) : glm::dvec2(0.0);
    const glm::dvec2 texel = glm::clamp((place / most + 1.0) * (0.5 * edge) - 0.5, 0.0, edge - 1.001);
    const auto column = static_cast<std::size_t>(texel.x), row = static_cast<std::size_t>(texel.y);
    const double right = texel.x - static_cast<double>(column), below = texel.y - static_cast<double>(row);
    const std::size_t first = row * static_cast<std::size_t>(edge_) + column;
    const std::size_t next = first + static_cast<std::size_t>(edge_);
    const double upper = (1.0 - right) * passed(*side, first, distance) + right * passed(*side, first + 1, distance);
    const double lower = (1.0 - right) * passed(*side, next, distance) + right * passed(*side, next + 1, distance);
    return (1.0 - below) * upper + below * lower;
}

}  // namespace lumulus::lamp
