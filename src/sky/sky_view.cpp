#include "sky/sky_view.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.h"
#include "sky/row_light.h"
#include "sky/shell.h"

namespace lumulus::sky {

namespace {

using std::numbers::pi;

/// The eye's least height: closer to the ground than this nothing changes but the formulas' digits.
constexpr double leastHeight = 0.5;
constexpr int steps = 32;

glm::vec4 texel(const glm::dvec3& rgb) {
    return {glm::vec3(rgb), 1.0F};
}

/// Cosine to the upward direction of a row of the table.
double cosineOfRow(const shared::SkyViewParams& p, double height, double floor, double horizonDistance, int row) {
    const double horizon = horizonCosine(height, floor), least = 1e-9;
    if (row < shared::SKY_ROWS) {
        const double v = row / (shared::SKY_ROWS - 1.0);
        return std::max(horizon + least, std::sin(std::asin(horizon) + static_cast<double>(p.highest) * v * v));
    }
    const double v = (row - shared::SKY_ROWS) / (shared::GROUND_ROWS - 1.0);
    const double d = height - floor + (horizonDistance - (height - floor)) * v * v;
    const double up = -(d * d + horizonDistance * horizonDistance) / (2.0 * d * (planetRadius + height));
    return std::clamp(up, -1.0, horizon - least);
}

/// `floor`: height at which rays end, the ground's where there is none.
SkyView makeTables(const Atmosphere& atmosphere, const glm::dvec3& eye, const scene::Sun& sun,
                   const std::optional<double>& end, const std::function<glm::dvec3(double, double)>& factor = {}) {
    const double floor = end.value_or(0.0), height = std::max(atmosphere.heightAt(eye), floor + leastHeight);
    const glm::dvec3 up = atmosphere.upAt(eye);
    const double sunUp = std::clamp(glm::dot(up, sun.directionTo), -1.0, 1.0);
    const double horizonDistance = std::sqrt((height - floor) * (2.0 * planetRadius + (height + floor)));
    SkyView view;
    shared::SkyViewParams& p = view.params;
    p.up = glm::vec3(up);
    turnTo(p, up, sun.directionTo);
    p.height = static_cast<float>(height - floor);
    p.planetHeight = static_cast<float>(planetRadius + height);
    p.horizon = static_cast<float>(std::asin(horizonCosine(height, floor)));
    const double top = height > airTop ? std::acos((planetRadius + airTop) / (planetRadius + height)) : -0.5 * pi;
    p.highest = static_cast<float>(-top - std::asin(horizonCosine(height, floor)));
    p.horizonDistance = static_cast<float>(horizonDistance);
    p.asymmetry = static_cast<float>(atmosphere.air().asymmetry);
    const glm::dvec3 scale = sun.irradiance / atmosphere.sunAbove();
    const double sunSine = std::sqrt(std::max(0.0, 1.0 - sunUp * sunUp));
    constexpr int rows = shared::SKY_ROWS + shared::GROUND_ROWS, columns = shared::SKY_COLUMNS;
    view.scattered.resize(static_cast<std::size_t>(rows) * columns);
    view.aerosol.resize(view.scattered.size());
    if (end) view.transmittance.resize(rows);
    tbb::parallel_for(0, rows, [&](int row) {
        const double cosine = cosineOfRow(p, height, floor, horizonDistance, row),
                     sine = std::sqrt(1.0 - cosine * cosine);
        const RowLight rays =
            end ? RowLight(atmosphere, height, cosine, sunUp, distanceToGround(height, cosine, floor), steps)
                : RowLight(atmosphere, height, cosine, sunUp, steps);
        const glm::dvec3 night = atmosphere.night(!end && row >= shared::SKY_ROWS, rays.transmittance());
        if (end)
            view.transmittance[static_cast<std::size_t>(row)] =
                texel(glm::max(atmosphere.air().rgb(rays.transmittance()), 0.0) / atmosphere.sunAbove());
        for (int column = 0; column < columns; ++column) {
            const double toSun = cosine * sunUp + sine * sunSine * std::cos(pi * std::pow(column / (columns - 1.0), 2));
            const AirLight light = rays.sky(std::clamp(toSun, -1.0, 1.0));
            const auto at = static_cast<std::size_t>(row * columns + column);
            const glm::dvec3 lit = factor && row < shared::SKY_ROWS
                                       ? scale * factor(cosine, pi * std::pow(column / (columns - 1.0), 2))
                                       : scale;
            view.scattered[at] = texel((atmosphere.air().rgb(light.scattered) + night) * lit);
            view.aerosol[at] = texel(atmosphere.air().rgb(light.aerosol) * lit);
        }
    });
    return view;
}

/// Of a table by direction, whose columns may be one.
glm::dvec3 inTable(const SkyView& view, const std::vector<glm::vec4>& texels, int columns, const glm::vec3& direction) {
    constexpr int rows = shared::SKY_ROWS + shared::GROUND_ROWS;
    const glm::vec2 place = shared::skyViewPlace(view.params, direction, shared::aboveHorizon(view.params, direction)) *
                                glm::vec2(columns, rows) -
                            0.5F;
    const glm::vec2 at = glm::clamp(place, glm::vec2(0.0F), glm::vec2(columns - 1, rows - 1));
    const glm::ivec2 first = glm::min(glm::ivec2(at), glm::ivec2(std::max(0, columns - 2), rows - 2));
    const glm::vec2 share = at - glm::vec2(first);
    const auto texelAt = [&](int x, int y) {
        return glm::vec3(texels[static_cast<std::size_t>(y * columns + std::min(x, columns - 1))]);
    };
    return glm::mix(glm::mix(texelAt(first.x, first.y), texelAt(first.x + 1, first.y), share.x),
                    glm::mix(texelAt(first.x, first.y + 1), texelAt(first.x + 1, first.y + 1), share.x), share.y);
}

}  // namespace

SkyView makeSkyView(const Atmosphere& atmosphere, const glm::dvec3& eye, const scene::Sun& sun) {
    if (!(atmosphere.heightAt(eye) > -leastHeight))
        throw InputError("the camera is below the ground", "camera.position",
                         "raise it above y = " + std::to_string(static_cast<int>(atmosphere.groundHeight())) +
                             ", the ground of the atmosphere");
    return makeTables(atmosphere, eye, sun, {});
}

SkyView makeSkyViewAbove(const Atmosphere& atmosphere, const glm::dvec3& eye, const scene::Sun& sun, double floor,
                         const std::function<glm::dvec3(double, double)>& scale) {
    return makeTables(atmosphere, eye, sun, floor, scale);
}

void turnTo(shared::SkyViewParams& params, const glm::dvec3& up, const glm::dvec3& toSun) {
    glm::dvec3 level = toSun - std::clamp(glm::dot(up, toSun), -1.0, 1.0) * up;
    if (glm::length(level) < 1e-9)
        level = glm::cross(up, std::abs(up.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1));
    params.sunAcross = glm::vec3(glm::normalize(level));
    params.toSun = glm::vec3(toSun);
}

glm::dvec3 radianceOf(const SkyView& view, const glm::dvec3& direction) {
    const glm::vec3 towards(direction);
    if (shared::aboveHorizon(view.params, towards) > view.params.highest) return glm::dvec3(0.0);
    const auto phase =
        static_cast<double>(shared::aerosolPhase(view.params.asymmetry, glm::dot(towards, view.params.toSun)));
    return glm::max(inTable(view, view.scattered, shared::SKY_COLUMNS, towards) +
                        phase * inTable(view, view.aerosol, shared::SKY_COLUMNS, towards),
                    0.0);
}

glm::dvec3 transmittanceOf(const SkyView& view, const glm::dvec3& direction) {
    return inTable(view, view.transmittance, 1, glm::vec3(direction));
}

namespace {

constexpr double endless = std::numeric_limits<double>::infinity();

/// The part of a ray that lies above a floor [m]: level layers below it when the eye is in them, a sphere else.
glm::dvec2 aboveFloor(const AirPoint& from, double floor) {
    if (from.height >= floor) return {0.0, distanceToGround(from.height, from.up, floor)};
    return {from.up > 0.0 ? (floor - from.height) / from.up : endless, endless};
}

/// Distances [m] below which a path takes fewer steps.
constexpr double nearBefore = 20e3, shortSlice = 300.0;

/// Texels across: 4° wide at most, where a picture is narrower than a panorama.
int airColumns(const Camera& camera) {
    if (camera.projection == scene::Projection::panorama) return 64;
    const double half = std::atan(camera.tanHalfFov * camera.pixelAspect * camera.width / camera.height);
    return std::clamp(static_cast<int>(std::ceil(2.0 * glm::degrees(half) / 4.0)), 8, 32);
}

}  // namespace

AirBetween makeAirBetween(const Atmosphere& atmosphere, const Camera& camera, const scene::Sun& sun, double nearest,
                          double farthest, std::optional<double> floor, bool coarse) {
    AirBetween between;
    between.size = {airColumns(camera), coarse ? 8 : 32, shared::AIR_SLICES};
    between.nearest = nearest;
    between.farthest = farthest;
    const auto texels = static_cast<std::size_t>(between.size.x * between.size.y);
    between.light.resize(texels * shared::AIR_SLICES);
    between.transmittance.resize(between.light.size());
    const glm::dvec3 above = atmosphere.sunAbove(), scale = sun.irradiance / above, none(0.0);
    tbb::parallel_for(std::size_t{0}, texels, [&](std::size_t place) {
        const auto column = static_cast<int>(place) % between.size.x, row = static_cast<int>(place) / between.size.x;
        const Ray ray =
            camera.ray((column + 0.5) * camera.width / between.size.x, (row + 0.5) * camera.height / between.size.y);
        const AirPoint from = atmosphere.at(ray.origin, ray.direction, sun.directionTo);
        const glm::dvec2 part = floor ? aboveFloor(from, *floor) : glm::dvec2(0.0, endless);
        double reached = std::clamp(nearest, part.x, std::max(part.x, part.y));
        AirLight light;
        if (!floor || reached > part.x)
            light =
                atmosphere.along(floor ? from.after(part.x) : from, reached - part.x, nearest < nearBefore ? 12 : 16);
        for (int slice = 0; slice < shared::AIR_SLICES; ++slice) {
            const double share = slice / (shared::AIR_SLICES - 1.0);
            const double distance =
                std::clamp(nearest + (farthest - nearest) * share * share, part.x, std::max(part.x, part.y));
            const double length = distance - reached;
            if (length > 0.0) atmosphere.extend(light, from.after(reached), length, length < shortSlice ? 1 : 2);
            reached = distance;
            const std::size_t at = static_cast<std::size_t>(slice) * texels + place;
            const Air& air = atmosphere.air();
            const glm::dvec3 through = glm::max(air.rgb(light.transmittance), none) / above;
            const glm::dvec3 night = (1.0 - through) * atmosphere.night(false, light.transmittance);
            between.light[at] = texel((glm::max(air.rgb(light.light(air, from.toSun)), none) + night) * scale);
            between.transmittance[at] = texel(through);
        }
    });
    return between;
}

}  // namespace lumulus::sky
