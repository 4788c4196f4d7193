#include "sky/sky_view.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
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
double cosineOfRow(const shared::SkyViewParams& p, double height, double horizonDistance, int row) {
    const double horizon = horizonCosine(height), least = 1e-9;
    if (row < shared::SKY_ROWS) {
        const double v = row / (shared::SKY_ROWS - 1.0);
        return std::max(horizon + least, std::sin(std::asin(horizon) + static_cast<double>(p.highest) * v * v));
    }
    const double v = (row - shared::SKY_ROWS) / (shared::GROUND_ROWS - 1.0);
    const double d = height + (horizonDistance - height) * v * v;
    const double up = -(d * d + horizonDistance * horizonDistance) / (2.0 * d * (planetRadius + height));
    return std::clamp(up, -1.0, horizon - least);
}

}  // namespace

SkyView makeSkyView(const Atmosphere& atmosphere, const glm::dvec3& eye, const scene::Sun& sun) {
    const double below = atmosphere.heightAt(eye);
    if (!(below > -leastHeight))
        throw InputError("the camera is below the ground", "camera.position",
                         "raise it above y = " + std::to_string(static_cast<int>(atmosphere.groundHeight())) +
                             ", the ground of the atmosphere");
    const double height = std::max(below, leastHeight);
    const glm::dvec3 up = atmosphere.upAt(eye);
    const double sunUp = std::clamp(glm::dot(up, sun.directionTo), -1.0, 1.0);
    glm::dvec3 level = sun.directionTo - sunUp * up;
    if (glm::length(level) < 1e-9)
        level = glm::cross(up, std::abs(up.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1));
    const double horizonDistance = std::sqrt(height * (2.0 * planetRadius + height));
    SkyView view;
    shared::SkyViewParams& p = view.params;
    p.up = glm::vec3(up);
    p.sunAcross = glm::vec3(glm::normalize(level));
    p.toSun = glm::vec3(sun.directionTo);
    p.height = static_cast<float>(height);
    p.planetHeight = static_cast<float>(planetRadius + height);
    p.horizon = static_cast<float>(std::asin(horizonCosine(height)));
    const double top = height > airTop ? std::acos((planetRadius + airTop) / (planetRadius + height)) : -0.5 * pi;
    p.highest = static_cast<float>(-top - std::asin(horizonCosine(height)));
    p.horizonDistance = static_cast<float>(horizonDistance);
    p.asymmetry = static_cast<float>(atmosphere.air().asymmetry);
    const glm::dvec3 scale = sun.irradiance / atmosphere.sunAbove();
    const double sunSine = std::sqrt(std::max(0.0, 1.0 - sunUp * sunUp));
    constexpr int rows = shared::SKY_ROWS + shared::GROUND_ROWS, columns = shared::SKY_COLUMNS;
    view.scattered.resize(static_cast<std::size_t>(rows) * columns);
    view.aerosol.resize(view.scattered.size());
    tbb::parallel_for(0, rows, [&](int row) {
        const double cosine = cosineOfRow(p, height, horizonDistance, row), sine = std::sqrt(1.0 - cosine * cosine);
        const AirPath path = atmosphere.path(height, cosine, steps);
        for (int column = 0; column < columns; ++column) {
            const double toSun = cosine * sunUp + sine * sunSine * std::cos(pi * std::pow(column / (columns - 1.0), 2));
            const AirLight light = atmosphere.sky({height, cosine, sunUp, std::clamp(toSun, -1.0, 1.0)}, path);
            const auto at = static_cast<std::size_t>(row * columns + column);
            view.scattered[at] = texel(atmosphere.air().rgb(light.scattered) * scale);
            view.aerosol[at] = texel(atmosphere.air().rgb(light.aerosol) * scale);
        }
    });
    return view;
}

AirBetween makeAirBetween(const Atmosphere& atmosphere, const Camera& camera, const scene::Sun& sun, double nearest,
                          double farthest) {
    constexpr int before = 16;
    const bool panorama = camera.projection == scene::Projection::panorama;
    AirBetween between;
    between.size = {panorama ? 64 : 32, 32, shared::AIR_SLICES};
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
        AirLight light = atmosphere.along(from, nearest, before);
        double reached = nearest;
        for (int slice = 0; slice < shared::AIR_SLICES; ++slice) {
            const double share = slice / (shared::AIR_SLICES - 1.0);
            const double distance = nearest + (farthest - nearest) * share * share;
            if (distance > reached) atmosphere.extend(light, from.after(reached), distance - reached, 2);
            reached = distance;
            const std::size_t at = static_cast<std::size_t>(slice) * texels + place;
            const Air& air = atmosphere.air();
            between.light[at] = texel(glm::max(air.rgb(light.light(air, from.toSun)), none) * scale);
            between.transmittance[at] = texel(glm::max(air.rgb(light.transmittance), none) / above);
        }
    });
    return between;
}

}  // namespace lumulus::sky
