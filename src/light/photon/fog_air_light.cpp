#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtx/component_wise.hpp>
#include <numbers>

#include "light/photon/air_box.h"
#include "light/photon/air_light.h"
#include "light/photon/emission.h"

namespace lumulus::photon {

namespace {

constexpr int columns = sky::SkyMaps::columns, rows = sky::SkyMaps::rows, cellCount = columns * rows;
constexpr int heights = shared::FOG_SKY_HEIGHTS;
/// Directions along each side of a cell.
constexpr int parts = 2;
constexpr glm::dvec3 up(0.0, 1.0, 0.0);

double heightAt(const glm::dvec2& ends, int row, int count) {
    return ends.x + (ends.y - ends.x) * row / (count - 1.0);
}

void addSun(AirLight& light, const fog_light::FogSurroundings& fog, const Box& box, const glm::dvec3& across) {
    const glm::dvec2 width = endsAlong(box, across), ends = endsAlong(box, up);
    const glm::dvec4 along = placeAlong(box, across, width), upwards = placeAlong(box, up, ends);
    light.place = {glm::vec3(along), glm::vec3(upwards), glm::vec2(along.w, upwards.w)};
    std::vector<glm::dvec3> shares;
    for (int row = 0; row < shared::SUN_COLOUR_ROWS; ++row) {
        shares.push_back(fog.sunShare(heightAt(ends, row, shared::SUN_COLOUR_ROWS)));
        light.mostSun = glm::max(light.mostSun, shares.back());
    }
    for (const glm::dvec3& share : shares)
        light.sunColours.insert(light.sunColours.end(), shared::SUN_COLOUR_COLUMNS,
                                glm::vec3(share / glm::max(light.mostSun, glm::dvec3(1e-30))));
}

/// A direction that is looked at: `u` within a cell of the map, 0 to 1.
glm::dvec3 directionIn(const glm::dmat3& axes, int row, int column, const glm::dvec2& u) {
    const double low = std::cos(std::numbers::pi * row / rows), high = std::cos(std::numbers::pi * (row + 1) / rows);
    const double sine = low + (high - low) * u.y, across = std::sqrt(std::max(0.0, 1.0 - sine * sine));
    const double azimuth = 2.0 * std::numbers::pi * (column + u.x) / columns;
    return axes * glm::dvec3(across * std::cos(azimuth), sine, across * std::sin(azimuth));
}

/// Mean radiance over a cell.
glm::dvec3 cellRadiance(const fog_light::FogSurroundings& fog, const glm::dmat3& axes, double height, int row,
                        int column) {
    glm::dvec3 sum(0.0);
    for (int i = 0; i < parts * parts; ++i)
        sum += fog.radiance(height,
                            directionIn(axes, row, column, {(i % parts + 0.5) / parts, (i / parts + 0.5) / parts}));
    return sum / static_cast<double>(parts * parts);
}

/// Radiance by height and cell. To both sides of the sun it is the same.
std::vector<glm::dvec3> radianceMaps(const fog_light::FogSurroundings& fog, const glm::dmat3& axes,
                                     const glm::dvec2& ends) {
    std::vector<glm::dvec3> maps(static_cast<std::size_t>(heights * cellCount));
    tbb::parallel_for(0, heights * rows, [&](int index) {
        const double height = heightAt(ends, index / rows, heights);
        for (int column = 0; column < columns / 2; ++column) {
            const glm::dvec3 seen = cellRadiance(fog, axes, height, index % rows, column);
            maps[static_cast<std::size_t>(index * columns + column)] = seen;
            maps[static_cast<std::size_t>(index * columns + columns - 1 - column)] = seen;
        }
    });
    return maps;
}

void addSky(AirLight& light, const fog_light::FogSurroundings& fog, const Box& box, const glm::dvec3& across) {
    const glm::dvec2 ends = endsAlong(box, up);
    const glm::dmat3 axes(across, up, glm::cross(across, up)), faces = faceAreas(box.edges, box.size);
    light.skyFrame.axes = axes;
    light.meanArea = 0.5 * (glm::length(faces[0]) + glm::length(faces[1]) + glm::length(faces[2]));
    light.cells.resize(cellCount);
    const std::vector<glm::dvec3> maps = radianceMaps(fog, axes, ends);
    std::vector<double> weights, areas, angles;
    double sum = 0.0;
    for (int cell = 0; cell < cellCount; ++cell) {
        const int row = cell / columns;
        angles.push_back((std::cos(std::numbers::pi * row / rows) - std::cos(std::numbers::pi * (row + 1) / rows)) *
                         2.0 * std::numbers::pi / columns);
        const glm::dvec3 towards = directionIn(axes, row, cell % columns, {0.5, 0.5});
        double area = 0.0;
        for (int axis = 0; axis < 3; ++axis) area += std::abs(glm::dot(faces[axis], towards));
        glm::dvec3 mean(0.0);
        for (int k = 0; k < heights; ++k)
            mean += maps[static_cast<std::size_t>(k * cellCount + cell)] / double(heights);
        areas.push_back(area);
        light.skyFlux += mean * (angles.back() * area);
        weights.push_back(luminance(mean) * angles.back() * area);
        sum += weights.back();
    }
    light.fogSky.assign(static_cast<std::size_t>(heights * cellCount), glm::vec3(0.0F));
    if (!(sum > 0.0)) return;
    makeAlias(weights, light.cells);
    const glm::dvec3 flux = glm::max(light.skyFlux, glm::dvec3(1e-30));
    for (std::size_t i = 0; i < light.fogSky.size(); ++i) {
        const std::size_t cell = i % cellCount;
        if (!(weights[cell] > 0.0)) continue;
        const glm::dvec3 weight = maps[i] * (angles[cell] / (weights[cell] / sum)) / flux;
        light.fogSky[i] = glm::vec3(weight);
        light.skyPeak = std::max(light.skyPeak, glm::compMax(weight) * areas[cell]);
        light.skyPeakDensity = std::max(light.skyPeakDensity, glm::compMax(weight));
    }
}

}  // namespace

AirLight makeFogAirLight(const fog_light::FogSurroundings& fog, bool withSky, const scene::Sun& sun, const Box& box) {
    AirLight light;
    light.sunAbove = sun.irradiance;
    light.origin = box.origin;
    const glm::dvec3 across = acrossOf(sun.directionTo, up);
    addSun(light, fog, box, across);
    if (!withSky) return light;
    addSky(light, fog, box, across);
    const glm::dvec2 ends = endsAlong(box, up);
    for (int k = 0; k < heights; ++k) light.fogSky.emplace_back(fog.fog.similarDepthBelow(heightAt(ends, k, heights)));
    return light;
}

}  // namespace lumulus::photon
