#include "light/photon/air_light.h"

#include <algorithm>
#include <cmath>
#include <glm/gtx/component_wise.hpp>

#include "light/photon/air_box.h"
#include "light/photon/emission.h"

namespace lumulus::photon {

namespace {

/// Light of the sky by direction, at the bottom and at the top of a cloud [W/(m² sr)].
struct SkyLight {
    sky::SkyCells frame;
    std::vector<glm::dvec3> low, high;
};

/// Cells across of a map at least, 0.7° wide.
constexpr int mapColumns = 512;

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

void addSky(AirLight& light, const SkyLight& sky, const Box& box) {
    const glm::dmat3 faces = faceAreas(box.edges, box.size);
    light.skyFrame = sky.frame;
    light.meanArea = 0.5 * (glm::length(faces[0]) + glm::length(faces[1]) + glm::length(faces[2]));
    light.cells.resize(sky.low.size());
    std::vector<double> weights;
    for (std::size_t cell = 0; cell < sky.low.size(); ++cell) {
        const glm::dvec3 towards = sky.frame.direction(static_cast<int>(cell), {0.5, 0.5});
        double area = 0.0;
        for (int axis = 0; axis < 3; ++axis) area += std::abs(glm::dot(faces[axis], towards));
        const glm::dvec3 both = 0.5 * (sky.low[cell] + sky.high[cell]);
        const double angle = sky.frame.solidAngle(static_cast<int>(cell));
        light.skyFlux += both * (angle * area);
        weights.push_back(luminance(both) * angle * area);
    }
    double sum = 0.0;
    for (const double weight : weights) sum += weight;
    if (!(sum > 0.0)) return;
    makeAlias(weights, light.cells);
    const glm::dvec3 flux = glm::max(light.skyFlux, glm::dvec3(1e-30));
    for (std::size_t cell = 0; cell < light.cells.size(); ++cell) {
        const double weight = weights[cell], angle = sky.frame.solidAngle(static_cast<int>(cell));
        if (!(weight > 0.0)) continue;
        shared::SkyCell& made = light.cells[cell];
        const glm::dvec3 scale = angle / (weight / sum) / flux;
        const glm::dvec3 low = sky.low[cell] * scale, high = sky.high[cell] * scale;
        made.low = glm::vec3(low);
        made.high = glm::vec3(high);
        const double area = weight / (luminance(0.5 * (sky.low[cell] + sky.high[cell])) * angle);
        light.skyPeak = std::max(light.skyPeak, glm::compMax(glm::max(low, high)) * area);
        light.skyPeakDensity = std::max(light.skyPeakDensity, glm::compMax(glm::max(low, high)));
    }
}

SkyLight skyLight(const sky::SkyMaps& maps, const glm::dvec2& heights) {
    SkyLight light{maps.frame(), {}, {}};
    for (int cell = 0; cell < sky::SkyMaps::cells; ++cell) {
        light.low.push_back(maps.radiance(cell, heights.x));
        light.high.push_back(maps.radiance(cell, heights.y));
    }
    return light;
}

}  // namespace

glm::dvec2 heightsOf(const sky::Atmosphere& atmosphere, const Box& box) {
    const glm::dvec3 middle = box.origin + box.edges * (0.5 * box.size);
    const glm::dvec2 ends = endsAlong(box, atmosphere.upAt(middle));
    const double height = atmosphere.heightAt(middle), half = 0.5 * (ends.y - ends.x);
    return {std::max(0.0, height - half), std::max(0.0, height + half)};
}

AirLight makeAirLight(const sky::Atmosphere& atmosphere, const sky::SkyMaps* maps, const scene::Sun& sun,
                      const Box& box) {
    AirLight light;
    light.sunAbove = sun.irradiance;
    const glm::dvec3 up = atmosphere.upAt(box.origin + box.edges * (0.5 * box.size));
    light.origin = box.origin;
    addSun(light, atmosphere, sun, box, acrossOf(sun.directionTo, up), up);
    if (maps != nullptr) addSky(light, skyLight(*maps, heightsOf(atmosphere, box)), box);
    return light;
}

AirLight makeMapLight(const sky::MapSky& map, const scene::Sun& sun, const Box& box) {
    AirLight light;
    light.sunAbove = sun.irradiance;
    light.mostSun = glm::dvec3(1.0);
    light.sunColours.assign(std::size_t{shared::SUN_COLOUR_COLUMNS} * shared::SUN_COLOUR_ROWS, glm::vec3(1.0F));
    light.origin = box.origin;
    const sky::LatLong cells = map.cells(mapColumns);
    SkyLight sky{{{cells.width, cells.height}, map.axes()}, {}, {}};
    for (const glm::vec3& pixel : cells.pixels) sky.low.emplace_back(pixel);
    sky.high = sky.low;
    addSky(light, sky, box);
    return light;
}

AirLight forArea(const AirLight& light, double area, const glm::dvec3& origin) {
    AirLight scaled = light;
    const double factor = area / light.meanArea;
    scaled.skyFlux *= factor;
    scaled.skyPeak = light.skyPeakDensity * light.meanArea;
    for (shared::SkyCell& cell : scaled.cells) {
        cell.low /= static_cast<float>(factor);
        cell.high /= static_cast<float>(factor);
    }
    const auto weights = static_cast<std::size_t>(shared::FOG_SKY_HEIGHTS * sky::SkyMaps::cells);
    for (std::size_t i = 0; i < std::min(weights, scaled.fogSky.size()); ++i)
        scaled.fogSky[i] /= static_cast<float>(factor);
    const glm::dvec3 shift = origin - light.origin;
    scaled.origin = origin;
    scaled.place.origin +=
        glm::vec2(glm::dot(glm::dvec3(light.place.across), shift), glm::dot(glm::dvec3(light.place.up), shift));
    return scaled;
}

}  // namespace lumulus::photon
