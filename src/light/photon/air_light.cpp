#include "light/photon/air_light.h"

#include <algorithm>
#include <cmath>
#include <glm/gtx/component_wise.hpp>

#include "light/photon/emission.h"

namespace lumulus::photon {

namespace {

constexpr int cellCount = sky::SkyMaps::cells;
static_assert(sky::SkyMaps::columns == shared::SKY_MAP_COLUMNS && sky::SkyMaps::rows == shared::SKY_MAP_ROWS);

/// Ends of a box along a direction of the world.
glm::dvec2 endsAlong(const Box& box, const glm::dvec3& direction) {
    glm::dvec2 ends(glm::dot(box.origin, direction));
    for (int axis = 0; axis < 3; ++axis) {
        const double length = glm::dot(box.edges[axis], direction) * box.size[axis];
        ends += glm::dvec2(std::min(0.0, length), std::max(0.0, length));
    }
    return ends;
}

/// A place from 0 to 1 along a direction: per voxel, and where voxel (0,0,0) lies.
glm::dvec4 placeAlong(const Box& box, const glm::dvec3& direction, const glm::dvec2& ends) {
    const double length = std::max(ends.y - ends.x, 1e-6);
    return glm::dvec4(glm::transpose(box.edges) * direction / length,
                      (glm::dot(box.origin, direction) - ends.x) / length);
}

/// Vose's alias table of weights, which need no sum: `keep` and `other` of the cells.
void makeAlias(const std::vector<double>& weights, std::vector<shared::SkyCell>& cells) {
    double sum = 0.0;
    for (const double weight : weights) sum += weight;
    std::vector<double> share;
    std::vector<std::size_t> small, large;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        share.push_back(weights[i] / sum * static_cast<double>(weights.size()));
        (share[i] < 1.0 ? small : large).push_back(i);
    }
    for (std::size_t i = 0; i < cells.size(); ++i) {
        cells[i].keep = 1.0F;
        cells[i].other = static_cast<std::uint32_t>(i);
    }
    while (!small.empty() && !large.empty()) {
        const std::size_t less = small.back(), more = large.back();
        small.pop_back();
        cells[less].keep = static_cast<float>(share[less]);
        cells[less].other = static_cast<std::uint32_t>(more);
        share[more] -= 1.0 - share[less];
        if (share[more] >= 1.0) continue;
        large.pop_back();
        small.push_back(more);
    }
}

void addSun(AirLight& light, const sky::Atmosphere& atmosphere, const scene::Sun& sun, const Box& box,
            const glm::dvec3& across, const glm::dvec3& up) {
    const glm::dvec2 width = endsAlong(box, across), heights = endsAlong(box, up);
    const glm::dvec4 along = placeAlong(box, across, width), upwards = placeAlong(box, up, heights);
    light.place = {glm::vec3(along), glm::vec3(upwards), glm::vec2(along.w, upwards.w)};
    const glm::dvec3 middle = box.origin + box.edges * (0.5 * box.size);
    std::vector<glm::dvec3> colours;
    for (int row = 0; row < shared::SUN_COLOUR_ROWS; ++row)
        for (int column = 0; column < shared::SUN_COLOUR_COLUMNS; ++column) {
            const double x = column / (shared::SUN_COLOUR_COLUMNS - 1.0), y = row / (shared::SUN_COLOUR_ROWS - 1.0);
            const glm::dvec3 point =
                middle + across * ((x - 0.5) * (width.y - width.x)) + up * ((y - 0.5) * (heights.y - heights.x));
            colours.push_back(atmosphere.sunColour(point, sun.directionTo));
            light.mostSun = glm::max(light.mostSun, colours.back());
        }
    for (const glm::dvec3& colour : colours)
        light.sunColours.emplace_back(colour / glm::max(light.mostSun, glm::dvec3(1e-30)));
}

void addSky(AirLight& light, const sky::Atmosphere& atmosphere, const sky::SkyMaps& maps, const Box& box,
            const glm::dvec3& up) {
    const glm::dvec3 middle = box.origin + box.edges * (0.5 * box.size);
    const glm::dvec2 ends = endsAlong(box, up);
    const double height = atmosphere.heightAt(middle), half = 0.5 * (ends.y - ends.x);
    const glm::dmat3 faces = faceAreas(box.edges, box.size);
    light.skyAxes = maps.axes();
    light.cells.resize(cellCount);
    std::vector<double> weights;
    for (int cell = 0; cell < cellCount; ++cell) {
        const glm::dvec3 towards = maps.direction(cell, {0.5, 0.5});
        double area = 0.0;
        for (int axis = 0; axis < 3; ++axis) area += std::abs(glm::dot(faces[axis], towards));
        const glm::dvec3 low = maps.radiance(cell, std::max(0.0, height - half));
        const glm::dvec3 high = maps.radiance(cell, std::max(0.0, height + half));
        const double angle = sky::SkyMaps::solidAngle(cell);
        light.skyFlux += 0.5 * (low + high) * (angle * area);
        weights.push_back(luminance(0.5 * (low + high)) * angle * area);
    }
    double sum = 0.0;
    for (const double weight : weights) sum += weight;
    if (!(sum > 0.0)) return;
    makeAlias(weights, light.cells);
    const glm::dvec3 flux = glm::max(light.skyFlux, glm::dvec3(1e-30));
    for (int cell = 0; cell < cellCount; ++cell) {
        const double weight = weights[static_cast<std::size_t>(cell)], angle = sky::SkyMaps::solidAngle(cell);
        if (!(weight > 0.0)) continue;
        shared::SkyCell& made = light.cells[static_cast<std::size_t>(cell)];
        const glm::dvec3 scale = angle / (weight / sum) / flux;
        const glm::dvec3 low = maps.radiance(cell, std::max(0.0, height - half)) * scale;
        const glm::dvec3 high = maps.radiance(cell, std::max(0.0, height + half)) * scale;
        made.low = glm::vec3(low);
        made.high = glm::vec3(high);
        const glm::dvec3 mean = 0.5 * (maps.radiance(cell, std::max(0.0, height - half)) +
                                       maps.radiance(cell, std::max(0.0, height + half)));
        const double area = weight / (luminance(mean) * angle);
        light.skyPeak = std::max(light.skyPeak, glm::compMax(glm::max(low, high)) * area);
    }
}

}  // namespace

AirLight makeAirLight(const sky::Atmosphere& atmosphere, const sky::SkyMaps& maps, const scene::Sun& sun,
                      const Box& box) {
    AirLight light;
    const glm::dvec3 up = atmosphere.upAt(box.origin + box.edges * (0.5 * box.size));
    addSun(light, atmosphere, sun, box, maps.axes()[0], up);
    addSky(light, atmosphere, maps, box, up);
    return light;
}

}  // namespace lumulus::photon
