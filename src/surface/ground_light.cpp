#include "surface/ground_light.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

namespace lumulus::surface {

namespace {

using std::numbers::pi;

constexpr int skyNodes = 48;      // along each side
constexpr int skyRays = 64;       // of a node
constexpr double skyReach = 2.0;  // around the clouds, in their heights above the ground
/// A sun lower than this throws shadows that end farther away than anybody looks.
constexpr double lowestSine = 0.01;

struct Extent {
    glm::dvec2 lower, upper;

    void add(const glm::dvec2& place) {
        lower = glm::min(lower, place);
        upper = glm::max(upper, place);
    }
};

/// Where the shadows of clouds may lie.
Extent shadowExtent(const query::Extent& clouds, double height, const glm::dvec3& directionTo) {
    Extent extent{glm::dvec2(clouds.lower.x, clouds.lower.z), glm::dvec2(clouds.lower.x, clouds.lower.z)};
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 at =
            glm::mix(clouds.lower, clouds.upper, glm::dvec3(corner & 1, (corner >> 1) & 1, corner >> 2));
        const double fall = std::max(0.0, at.y - height) / std::max(directionTo.y, lowestSine);
        extent.add({at.x - fall * directionTo.x, at.z - fall * directionTo.z});
    }
    return extent;
}

GroundGrid gridOver(const Extent& extent, double finest, double most) {
    GroundGrid grid;
    const glm::dvec2 size = glm::max(extent.upper - extent.lower, glm::dvec2(finest));
    const double spacing = std::max(finest, std::sqrt(size.x * size.y / most));
    grid.nodes = glm::ivec2(glm::ceil(glm::min(size / spacing, glm::dvec2(most)))) + 1;
    grid.lower = extent.lower;
    grid.upper = extent.lower + size;
    grid.values.resize(static_cast<std::size_t>(grid.nodes.x) * static_cast<std::size_t>(grid.nodes.y));
    return grid;
}

template <typename ValueAt>
void fill(GroundGrid& grid, const ValueAt& valueAt, const Check& check) {
    tbb::parallel_for(0, grid.nodes.y, [&](int z) {
        check();
        for (int x = 0; x < grid.nodes.x; ++x)
            grid.values[static_cast<std::size_t>(z) * static_cast<std::size_t>(grid.nodes.x) +
                        static_cast<std::size_t>(x)] = glm::vec3(valueAt(x, z));
    });
}

/// A number in [0,1) that differs from node to node.
double scattered(int x, int z, int number) {
    auto h = static_cast<std::uint32_t>(x) * 0x9E3779B1U ^ static_cast<std::uint32_t>(z) * 0x85EBCA77U ^
             static_cast<std::uint32_t>(number) * 0xC2B2AE3DU;
    h = (h ^ (h >> 15U)) * 0x2C1B3C6DU;
    h = (h ^ (h >> 12U)) * 0x297A2D39U;
    return static_cast<double>(h ^ (h >> 15U)) / 4294967296.0;
}

/// Share of the light of a sky of one radiance that arrives at a place: points of a Fibonacci spiral over the
/// hemisphere, as dense as the cosine, shifted from node to node.
glm::dvec3 skyShare(const query::Media& media, const glm::dvec3& point, int x, int z) {
    const double first = scattered(x, z, 1), second = scattered(x, z, 2);
    glm::dvec3 sum(0.0);
    for (int i = 0; i < skyRays; ++i) {
        const double u = std::fmod((i + first) / skyRays, 1.0);
        const double azimuth = 2.0 * pi * std::fmod(i * 0.6180339887498949 + second, 1.0);
        const double sine = std::sqrt(u);
        sum += media.along({point, {sine * std::cos(azimuth), std::sqrt(1.0 - u), sine * std::sin(azimuth)}})
                   .transmittance();
    }
    return sum / static_cast<double>(skyRays);
}

}  // namespace

glm::dvec2 GroundGrid::node(int x, int z) const {
    return lower + (upper - lower) * glm::dvec2(x, z) / glm::dvec2(nodes - 1);
}

glm::dvec3 GroundGrid::at(const glm::dvec2& place) const {
    if (nodes.x == 0) return outside;
    const glm::dvec2 scaled = (place - lower) / (upper - lower) * glm::dvec2(nodes - 1);
    // from the outermost nodes on the value goes over into that of outside
    if (!(scaled.x > -1.0 && scaled.y > -1.0 && scaled.x < nodes.x && scaled.y < nodes.y)) return outside;
    const glm::ivec2 first(glm::floor(scaled));
    const glm::dvec2 f = scaled - glm::dvec2(first);
    const auto get = [&](int x, int z) -> glm::dvec3 {
        if (x < 0 || z < 0 || x >= nodes.x || z >= nodes.y) return outside;
        return values[static_cast<std::size_t>(z) * static_cast<std::size_t>(nodes.x) + static_cast<std::size_t>(x)];
    };
    return glm::mix(glm::mix(get(first.x, first.y), get(first.x + 1, first.y), f.x),
                    glm::mix(get(first.x, first.y + 1), get(first.x + 1, first.y + 1), f.x), f.y);
}

void GroundGrid::smooth() {
    const std::vector<glm::vec3> from = values;
    const auto get = [&](int x, int z) {
        const glm::ivec2 n = glm::clamp(glm::ivec2(x, z), glm::ivec2(0), nodes - 1);
        return from[static_cast<std::size_t>(n.y) * static_cast<std::size_t>(nodes.x) + static_cast<std::size_t>(n.x)];
    };
    std::size_t i = 0;
    for (int z = 0; z < nodes.y; ++z)
        for (int x = 0; x < nodes.x; ++x, ++i) {
            glm::vec3 sum(0.0F);
            for (int a = -1; a <= 1; ++a)
                for (int b = -1; b <= 1; ++b)
                    sum += get(x + a, z + b) * ((a == 0 ? 0.5F : 0.25F) * (b == 0 ? 0.5F : 0.25F));
            values[i] = sum;
        }
}

GroundLight::GroundLight(const scene::Ground& ground, const query::Media& media, const glm::dvec3& sky,
                         const Check& check)
    : ground_(ground), openSky_(pi * sky) {
    clouds_.outside = glm::vec3(0.0F);
    const glm::dvec3 foot(0.0, ground.height, 0.0);
    if (!media.fog.media.empty()) sky_.outside = glm::vec3(skyShare({{}, media.fog, {}}, foot, 0, 0));
    const std::optional<query::Extent> clouds = media.clouds.extent();
    if (!clouds || clouds->upper.y <= ground.height || openSky_ == glm::dvec3(0.0)) return;
    const double reach = skyReach * (clouds->upper.y - ground.height);
    const Extent around{glm::dvec2(clouds->lower.x, clouds->lower.z) - reach,
                        glm::dvec2(clouds->upper.x, clouds->upper.z) + reach};
    const glm::vec3 outside = sky_.outside;
    sky_ = gridOver(around, media.clouds.finestVoxel(), skyNodes * skyNodes);
    sky_.outside = outside;
    fill(
        sky_, [&](int x, int z) { return skyShare(media, onGround(sky_.node(x, z)), x, z); }, check);
    sky_.smooth();
}

glm::dvec3 GroundLight::onGround(const glm::dvec2& place) const {
    return {place.x, ground_.height, place.y};
}

void GroundLight::setSun(const query::Media& media, const scene::Sun& sun, double nodes, const Check& check) {
    openSun_ = sun.irradiance * std::max(0.0, sun.directionTo.y);
    sun_ = {};
    if (openSun_ == glm::dvec3(0.0)) return;
    const glm::vec3 outside(
        query::Media{{}, media.fog, {}}.along({onGround({0.0, 0.0}), sun.directionTo}).transmittance());
    const std::optional<query::Extent> clouds = media.clouds.extent();
    if (clouds && clouds->upper.y > ground_.height) {
        sun_ = gridOver(shadowExtent(*clouds, ground_.height, sun.directionTo), media.clouds.finestVoxel(), nodes);
        fill(
            sun_,
            [&](int x, int z) {
                return media.along({onGround(sun_.node(x, z)), sun.directionTo}).transmittance();
            },
            check);
    }
    sun_.outside = outside;
}

void GroundLight::setSky(const glm::dvec3& radiance) {
    openSky_ = pi * radiance;
}

std::array<glm::dvec2, 2> GroundLight::shaded() const {
    std::array<glm::dvec2, 2> corners{glm::dvec2(1e300), glm::dvec2(-1e300)};
    for (const GroundGrid* grid : {&sun_, &sky_, &clouds_}) {
        if (grid->nodes.x == 0) continue;
        const glm::dvec2 spacing = (grid->upper - grid->lower) / glm::dvec2(glm::max(grid->nodes - 1, glm::ivec2(1)));
        const glm::dvec2 moved = grid == &clouds_ ? glm::dvec2(0.0) : drift_;
        corners = {glm::min(corners[0], grid->lower - spacing + moved),
                   glm::max(corners[1], grid->upper + spacing + moved)};
    }
    for (const GroundGrid* grid : {&meshes_.sky, &meshes_.added})
        if (grid->nodes.x > 0) corners = {glm::min(corners[0], grid->lower), glm::max(corners[1], grid->upper)};
    if (meshes_.sun) corners = {glm::min(corners[0], meshes_.lower), glm::max(corners[1], meshes_.upper)};
    return corners;
}

void GroundLight::setMeshes(GroundMeshes meshes) {
    meshes_ = std::move(meshes);
}

glm::dvec3 GroundLight::directRadiance(const glm::dvec2& place) const {
    return ground_.albedo / pi *
           (openSun_ * sun_.at(place - drift_) * meshes_.sunAt(place) +
            openSky_ * sky_.at(place - drift_) * meshes_.sky.at(place) + meshes_.added.at(place));
}

glm::dvec3 GroundLight::openRadiance() const {
    return ground_.albedo / pi * (openSun_ * glm::dvec3(sun_.outside) + openSky_ * glm::dvec3(sky_.outside));
}

glm::dvec3 GroundLight::radiance(const glm::dvec2& place) const {
    return directRadiance(place) + ground_.albedo / pi * clouds_.at(place) * meshes_.sky.at(place);
}

void GroundLight::setClouds(GroundGrid irradiance) {
    clouds_ = std::move(irradiance);
}

}  // namespace lumulus::surface
