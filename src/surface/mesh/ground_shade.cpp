#include "surface/mesh/ground_shade.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lumulus::surface {
namespace {

using std::numbers::pi;

constexpr int nodes = 96;      // of the grid of the sky, along each side
constexpr int skyRays = 64;    // of a node
constexpr double reach = 1.5;  // of that grid around the meshes, in their heights above the ground
/// Rays to the sun's disc: where the first ones do not agree, all.
constexpr int firstSunRays = 4, sunRays = 16;
/// A sun lower than this throws shadows that end farther away than anybody looks.
constexpr double lowestSine = 0.01;
constexpr double goldenRatio = 0.6180339887498949;

/// A number in [0,1) that differs from place to place.
double scattered(const glm::dvec2& place, std::uint32_t number) {
    const glm::ivec2 cell(glm::fract(place * 37.1) * 1048576.0);
    auto h = static_cast<std::uint32_t>(cell.x) * 0x9E3779B1U ^ static_cast<std::uint32_t>(cell.y) * 0x85EBCA77U ^
             number * 0xC2B2AE3DU;
    h = (h ^ (h >> 15U)) * 0x2C1B3C6DU;
    h = (h ^ (h >> 12U)) * 0x297A2D39U;
    return static_cast<double>(h ^ (h >> 15U)) * 0x1p-32;
}

class Shade {
  public:
    Shade(const MeshScene& scene, const scene::Ground& ground, const scene::Sun& sun, const glm::dvec3& sky)
        : scene_(scene),
          ground_(ground),
          sun_(sun),
          sky_(sky),
          disc_(std::sin(glm::radians(0.5 * sun.angularDiameter))) {
        const glm::dvec3 aside = std::abs(sun.directionTo.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
        across_ = glm::normalize(glm::cross(aside, sun.directionTo));
        up_ = glm::cross(sun.directionTo, across_);
    }

    /// Share of the sun's disc that is seen from a place.
    double sunSeen(const glm::dvec2& place) const {
        const double turned = scattered(place, 1U);
        const auto open = [&](double share, double angle) {
            const double away = disc_ * std::sqrt(share);
            return !meets(place, sun_.directionTo * std::sqrt(1.0 - away * away) +
                                     away * (std::cos(angle) * across_ + std::sin(angle) * up_));
        };
        int seen = 0;
        for (int i = 0; i < firstSunRays; ++i) seen += open(0.6, 2.0 * pi * (i + turned) / firstSunRays) ? 1 : 0;
        if (seen == 0 || seen == firstSunRays) return seen == 0 ? 0.0 : 1.0;
        seen = 0;
        for (int i = 0; i < sunRays; ++i)
            seen += open((i + 0.5) / sunRays, 2.0 * pi * (i * goldenRatio + turned)) ? 1 : 0;
        return static_cast<double>(seen) / sunRays;
    }

    /// Share of the light of a sky of one radiance that meshes leave, and the irradiance by what hides it [W/m²].
    std::pair<double, glm::dvec3> around(const glm::dvec2& place) const {
        const double first = scattered(place, 2U), second = scattered(place, 3U);
        int open = 0;
        glm::dvec3 radiance(0.0);
        for (int i = 0; i < skyRays; ++i) {
            const double u = std::fmod((i + first) / skyRays, 1.0);
            const double azimuth = 2.0 * pi * std::fmod(i * goldenRatio + second, 1.0), sine = std::sqrt(u);
            const glm::dvec3 direction(sine * std::cos(azimuth), std::sqrt(1.0 - u), sine * std::sin(azimuth));
            const auto met = scene_.meet({at(place), direction}, farAway);
            if (met)
                radiance += sent(scene_.at(met->hit, direction));
            else
                ++open;
        }
        return {static_cast<double>(open) / skyRays, pi / skyRays * radiance};
    }

  private:
    static constexpr double farAway = 1e9;  // metres

    glm::dvec3 at(const glm::dvec2& place) const { return {place.x, ground_.height, place.y}; }
    bool meets(const glm::dvec2& place, const glm::dvec3& direction) const {
        return scene_.meet({at(place), direction}, farAway).has_value();
    }

    /// Radiance of a mesh without what it emits, which few rays would find: as if it was matte and stood between the
    /// sky and a ground without shadows.
    glm::dvec3 sent(const MeshPoint& point) const {
        const double up = 0.5 + 0.5 * point.normal.y, facing = glm::dot(point.normal, sun_.directionTo);
        const glm::dvec3 below = ground_.albedo * (sky_ + sun_.irradiance * std::max(0.0, sun_.directionTo.y) / pi);
        glm::dvec3 light = glm::mix(below, sky_, up);
        if (facing > 0.0 && !scene_.meet({point.position, sun_.directionTo}, farAway, point.instance, point.triangle))
            light += sun_.irradiance * facing / pi;
        return glm::min(point.material.albedo + point.material.reflectance, 1.0) * light;
    }

    const MeshScene& scene_;
    scene::Ground ground_;
    scene::Sun sun_;
    glm::dvec3 sky_, across_, up_;
    double disc_;
};

}  // namespace

GroundMeshes shadeOnGround(const MeshScene& scene, const scene::Ground& ground, const scene::Sun& sun,
                           const glm::dvec3& sky, const Check& check) {
    const glm::dvec3 lower = scene.world.middle + glm::dvec3(scene.world.box.lower),
                     upper = scene.world.middle + glm::dvec3(scene.world.box.upper);
    GroundMeshes meshes;
    const double height = upper.y - ground.height;
    if (!(height > 0.0)) return meshes;
    const Shade shade(scene, ground, sun, sky);
    meshes.sky.lower = glm::dvec2(lower.x, lower.z) - reach * height;
    meshes.sky.upper = glm::dvec2(upper.x, upper.z) + reach * height;
    meshes.sky.nodes = glm::ivec2(nodes);
    meshes.sky.values.resize(nodes * nodes);
    meshes.added = meshes.sky;
    meshes.added.outside = glm::vec3(0.0F);
    tbb::parallel_for(0, nodes, [&](int z) {
        check();
        for (int x = 0; x < nodes; ++x) {
            const auto [open, irradiance] = shade.around(meshes.sky.node(x, z));
            const auto i = static_cast<std::size_t>(z * nodes + x);
            meshes.sky.values[i] = glm::vec3(static_cast<float>(open));
            meshes.added.values[i] = glm::vec3(irradiance);
        }
    });
    meshes.sky.smooth();
    meshes.added.smooth();
    const double fall = height / std::max(sun.directionTo.y, lowestSine);
    const glm::dvec2 shift = -fall * glm::dvec2(sun.directionTo.x, sun.directionTo.z);
    const double blur = fall * 2.0 * glm::radians(sun.angularDiameter);
    meshes.lower = glm::min(glm::dvec2(lower.x, lower.z), glm::dvec2(lower.x, lower.z) + shift) - blur;
    meshes.upper = glm::max(glm::dvec2(upper.x, upper.z), glm::dvec2(upper.x, upper.z) + shift) + blur;
    meshes.sun = [shade, from = meshes.lower, to = meshes.upper](const glm::dvec2& place) {
        const bool within = glm::all(glm::greaterThan(place, from)) && glm::all(glm::lessThan(place, to));
        return within ? shade.sunSeen(place) : 1.0;
    };
    return meshes;
}

}  // namespace lumulus::surface
