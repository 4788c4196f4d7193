// Tables that the GPU reads of an atmosphere, against the atmosphere itself.
#include "sky/sky_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "light/photon/air_light.h"
#include "light/photon/emission.h"
#include "scene/sunlight.h"
#include "sky/sky_maps.h"

namespace lumulus::sky {
namespace {

using glm::dvec3;
using std::numbers::pi;

const Atmosphere& atmosphere() {
    static const Atmosphere made{scene::Sky{}};
    return made;
}

scene::Sun sunAt(double elevation) {
    scene::Sun sun;
    sun.directionTo = scene::skyDirection(0.0, elevation);
    sun.irradiance = scene::sunAboveAir;
    return sun;
}

/// As a sampler interpolates a table.
glm::vec3 sampled(const std::vector<glm::vec4>& texels, const glm::vec2& place) {
    constexpr int width = shared::SKY_COLUMNS, height = shared::SKY_ROWS + shared::GROUND_ROWS;
    const glm::vec2 at =
        glm::clamp(place * glm::vec2(width, height) - 0.5F, glm::vec2(0), glm::vec2(width - 1, height - 1));
    const glm::ivec2 base = glm::min(glm::ivec2(at), glm::ivec2(width - 2, height - 2));
    const glm::vec2 f = at - glm::vec2(base);
    const auto texel = [&](int x, int y) {
        return glm::vec3(texels[static_cast<std::size_t>((base.y + y) * width + base.x + x)]);
    };
    return glm::mix(glm::mix(texel(0, 0), texel(1, 0), f.x), glm::mix(texel(0, 1), texel(1, 1), f.x), f.y);
}

dvec3 shown(const SkyView& view, const dvec3& direction) {
    const glm::vec3 d(direction);
    const glm::vec2 place = shared::skyViewPlace(view.params, d, shared::aboveHorizon(view.params, d));
    const float phase = shared::aerosolPhase(view.params.asymmetry, glm::dot(d, view.params.toSun));
    return dvec3(glm::max(sampled(view.scattered, place) + phase * sampled(view.aerosol, place), glm::vec3(0.0F)));
}

/// Relative errors of the table's luminance, sorted, for directions above the horizon or below.
std::vector<double> errors(double height, double elevation, bool above) {
    const scene::Sun sun = sunAt(elevation);
    const dvec3 eye(0.0, height, 0.0);
    const SkyView view = makeSkyView(atmosphere(), eye, sun);
    const auto horizon = static_cast<double>(view.params.horizon);
    std::vector<double> found;
    for (int i = 0; i < 400; ++i) {
        const double u = std::fmod(0.5 + 0.754877666 * i, 1.0), v = std::fmod(0.5 + 0.569840296 * i, 1.0);
        const double reach = above ? static_cast<double>(view.params.highest) : -0.5 * pi - horizon;
        const double angle = horizon + reach * (0.004 + 0.99 * v * v), azimuth = 2.0 * pi * u;
        const dvec3 direction(std::cos(angle) * std::sin(azimuth), std::sin(angle),
                              std::cos(angle) * std::cos(azimuth));
        const double exact = photometric(atmosphere().radiance(eye, direction, sun.directionTo));
        found.push_back(std::abs(photometric(shown(view, direction)) / exact - 1.0));
    }
    std::ranges::sort(found);
    return found;
}

TEST(SkyView, ShowsTheSkyThatTheAirHas) {
    for (const double height : {2.0, 500.0, 8000.0})
        for (const double sun : {60.0, 10.0, 0.0, -4.0}) {
            const std::vector<double> found = errors(height, sun, true);
            // with a sun at the horizon or below the edge of the planet's shadow falls between steps
            EXPECT_LT(found[found.size() * 99 / 100], sun < 1.0 ? 0.02 : 0.005) << height << " " << sun;
        }
}

TEST(SkyView, ShowsTheGround) {
    for (const double height : {2.0, 500.0, 8000.0, 4e5})
        for (const double sun : {60.0, 10.0}) {
            const std::vector<double> found = errors(height, sun, false);
            EXPECT_LT(found[found.size() * 95 / 100], 0.01) << height << " " << sun;
        }
}

/// From orbit the air is a thin rim; beyond it there is nothing.
TEST(SkyView, ShowsTheRimOfThePlanet) {
    const std::vector<double> found = errors(4e5, 30.0, true);
    EXPECT_LT(found[found.size() * 95 / 100], 0.03);
    const SkyView view = makeSkyView(atmosphere(), {0.0, 4e5, 0.0}, sunAt(30.0));
    EXPECT_LT(static_cast<double>(view.params.highest), glm::radians(6.0));
}

TEST(SkyView, RefusesAnEyeBelowTheGround) {
    EXPECT_THROW(makeSkyView(atmosphere(), {0.0, -3.0, 0.0}, sunAt(30.0)), InputError);
    EXPECT_NO_THROW(makeSkyView(atmosphere(), {0.0, 0.0, 0.0}, sunAt(90.0)));
}

/// The air between eye and cloud by the table, against the path itself.
TEST(SkyView, AirBetweenIsThatOfThePath) {
    scene::Camera from;
    from.position = dvec3(0.0, 50.0, 0.0);
    from.target = dvec3(0.0, 2000.0, -9000.0);
    scene::Image image;
    image.width = image.height = 64;
    const Camera camera = makeCamera(from, image, Bounds{});
    const scene::Sun sun = sunAt(20.0);
    const AirBetween between = makeAirBetween(atmosphere(), camera, sun, 3000.0, 30000.0);
    const int row = 20, column = between.size.x / 3, slice = 18;
    const Ray ray = camera.ray((column + 0.5) * 64.0 / between.size.x, (row + 0.5) * 2.0);
    const double share = std::pow(slice / (shared::AIR_SLICES - 1.0), 2), away = 3000.0 + 27000.0 * share;
    const AirPoint start = atmosphere().at(ray.origin, ray.direction, sun.directionTo);
    const AirLight exact = atmosphere().along(start, away, 400);
    const Air& air = atmosphere().air();
    const dvec3 light = air.rgb(exact.light(air, start.toSun)), through = air.rgb(exact.transmittance) / air.sunAbove();
    const auto at = static_cast<std::size_t>((slice * between.size.y + row) * between.size.x + column);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(static_cast<double>(between.light[at][c]), light[c], 0.01 * light[c]);
        EXPECT_NEAR(static_cast<double>(between.transmittance[at][c]), through[c], 0.002);
    }
}

/// The maps hold the irradiance of the sky, and do not know left from right of the sun.
TEST(SkyMaps, HoldTheIrradiance) {
    const scene::Sun sun = sunAt(30.0);
    const SkyMaps maps(atmosphere(), dvec3(0.0), sun);
    dvec3 sum(0.0);
    double sphere = 0.0;
    for (int cell = 0; cell < SkyMaps::cells; ++cell) {
        const double up = maps.frame().direction(cell, {0.5, 0.5}).y;
        sphere += maps.frame().solidAngle(cell);
        sum += maps.radiance(cell, 0.0) * (std::max(0.0, up) * maps.frame().solidAngle(cell));
    }
    const dvec3 exact = atmosphere().skyIrradiance(dvec3(0.0), sun.directionTo);
    EXPECT_NEAR(sphere, 4.0 * pi, 1e-9);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], exact[c], 0.01 * exact[c]);
}

photon::Box cube(double bottom) {
    return {{-500.0, bottom, -500.0}, glm::dmat3(10.0), {100.0, 150.0, 100.0}};
}

/// Weights of photons, by the probabilities of their cells, add up to the flux through the box; channel by channel.
TEST(AirLight, WeightsOfPhotonsAreTheFlux) {
    const scene::Sun sun = sunAt(10.0);
    const SkyMaps maps(atmosphere(), dvec3(0.0), sun);
    const photon::Box box = cube(800.0);
    const photon::AirLight light = photon::makeAirLight(atmosphere(), &maps, sun, box);
    std::vector<double> probability(light.cells.size(), 0.0);
    for (std::size_t i = 0; i < light.cells.size(); ++i) {
        const double each = 1.0 / static_cast<double>(light.cells.size());
        probability[i] += each * static_cast<double>(light.cells[i].keep);
        probability[light.cells[i].other] += each * (1.0 - static_cast<double>(light.cells[i].keep));
    }
    const glm::dmat3 faces = photon::faceAreas(box.edges, box.size);
    dvec3 weight(0.0), flux(0.0);
    double total = 0.0, peak = 0.0;
    for (int cell = 0; cell < SkyMaps::cells; ++cell) {
        const auto at = static_cast<std::size_t>(cell);
        const dvec3 towards = maps.frame().direction(cell, {0.5, 0.5});
        double area = 0.0;
        for (int axis = 0; axis < 3; ++axis) area += std::abs(glm::dot(faces[axis], towards));
        const dvec3 mean = 0.5 * dvec3(light.cells[at].low + light.cells[at].high) * area;
        weight += probability[at] * mean;
        total += probability[at];
        for (int c = 0; c < 3; ++c) peak = std::max(peak, static_cast<double>(light.cells[at].high[c]) * area);
        flux += 0.5 * (maps.radiance(cell, 800.0) + maps.radiance(cell, 2300.0)) * area * maps.frame().solidAngle(cell);
    }
    EXPECT_NEAR(total, 1.0, 1e-9);
    EXPECT_LE(peak, 1.0001 * light.skyPeak);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(weight[c], 1.0, 1e-4) << c;
        EXPECT_NEAR(light.skyFlux[c], flux[c], 0.005 * flux[c]) << c;
    }
}

/// The sun's light at a voxel by the table, against the air there.
TEST(AirLight, SunByPlace) {
    for (const double elevation : {30.0, 5.0, 1.0}) {
        const scene::Sun sun = sunAt(elevation);
        const SkyMaps maps(atmosphere(), dvec3(0.0), sun);
        const photon::Box box = cube(1000.0);
        const photon::AirLight light = photon::makeAirLight(atmosphere(), &maps, sun, box);
        for (const glm::dvec3 voxel : {dvec3(50, 75, 50), dvec3(10, 3, 90), dvec3(99, 149, 1)}) {
            const glm::vec2 place = shared::airPlace(light.place, glm::vec3(voxel)) *
                                    glm::vec2(shared::SUN_COLOUR_COLUMNS - 1, shared::SUN_COLOUR_ROWS - 1);
            const glm::ivec2 base =
                glm::min(glm::ivec2(place), glm::ivec2(shared::SUN_COLOUR_COLUMNS - 2, shared::SUN_COLOUR_ROWS - 2));
            const glm::vec2 f = place - glm::vec2(base);
            const auto texel = [&](int x, int y) {
                return light
                    .sunColours[static_cast<std::size_t>((base.y + y) * shared::SUN_COLOUR_COLUMNS + base.x + x)];
            };
            const dvec3 found =
                dvec3(glm::mix(glm::mix(texel(0, 0), texel(1, 0), f.x), glm::mix(texel(0, 1), texel(1, 1), f.x), f.y)) *
                light.mostSun;
            const dvec3 exact = atmosphere().sunColour(box.origin + box.edges * voxel, sun.directionTo);
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], exact[c], 0.04 * exact[c]) << elevation << " " << c;
        }
    }
}

}  // namespace
}  // namespace lumulus::sky
