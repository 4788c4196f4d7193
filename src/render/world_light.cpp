#include <algorithm>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

#include "light/photon/ground.h"
#include "medium/fog_media.h"
#include "render/world.h"
#include "render/world_fog.h"

// The light that reaches the clouds of a world.
namespace lumulus {

namespace {

/// Share of the sun's light that fog lets through to an instance.
glm::dvec3 sunThroughFog(const World& world, const cloud::Instance& instance) {
    if (world.fog.media.empty()) return glm::dvec3(1.0);
    return fog::sunTransmittance(world.fog, instance.bounds.centre, world.lights.direct().directionTo);
}

/// Where the instances are now, and what of the sun's light reaches them; that which air takes differs by place, and
/// is not in it.
std::vector<photon::Placement> placements(const World& world, const std::vector<std::size_t>& visible) {
    std::vector<photon::Placement> places;
    for (const std::size_t i : visible) {
        const cloud::Instance& instance = world.instances[i];
        const glm::dvec3 &reaching = world.light[i].sun.irradiance, &whole = world.lights.direct().irradiance;
        photon::Placement place{instance.origin + instance.offset, instance.medium.extinction, glm::dvec3(1.0)};
        for (int channel = 0; channel < 3; ++channel)
            if (whole[channel] > 0.0) place.sunShare[channel] = reaching[channel] / whole[channel];
        if (world.air) place.sunShare = world.fogLight ? glm::dvec3(1.0) : sunThroughFog(world, instance);
        places.push_back(place);
    }
    return places;
}

/// Maps of the sky above the middle of the clouds, which lie in this box.
const sky::SkyMaps& skyMapsOf(World& world, const photon::Box& box) {
    const glm::dvec3& middle = world.bounds.centre;
    const sky::Atmosphere& air = *world.lights.environment.atmosphere();
    return world.lights.skyMaps({middle.x, air.groundHeight(), middle.z}, photon::heightsOf(air, box));
}

photon::Box boxOf(const cloud::Instance& instance) {
    return {instance.origin + instance.offset, instance.voxelToMetres, glm::dvec3(instance.asset->size)};
}

/// The box along the axes of the world around all that is visible.
photon::Box boxOfAll(const World& world) {
    glm::dvec3 lower(std::numeric_limits<double>::infinity()), upper = -lower;
    for (const std::size_t i : world.visible()) {
        const photon::Box box = boxOf(world.instances[i]);
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 at(corner & 1, (corner >> 1) & 1, corner >> 2);
            const glm::dvec3 point = box.origin + box.edges * (at * box.size);
            lower = glm::min(lower, point), upper = glm::max(upper, point);
        }
    }
    return {lower, glm::dmat3(1.0), upper - lower};
}

/// Light of a map in the one instance, or in all together. It stays what it is, wherever they drift.
void findMapLight(World& world, const sky::MapSky& map) {
    const std::vector<std::size_t> visible = world.visible();
    if (visible.empty()) return;
    const bool many = visible.size() > 1;
    std::optional<photon::AirLight>& light = many ? world.air : world.light[visible.front()].air;
    if (!light)
        light = photon::makeMapLight(map, world.lights.sun,
                                     many ? boxOfAll(world) : boxOf(world.instances[visible.front()]));
    light->sunAbove = world.lights.sun.irradiance;
}

/// Light of the sky that goes to and fro along lines of sight, where all clouds have one medium with a backward peak.
std::optional<photon::SkyReturn> skyReturnIn(const World& world) {
    const std::vector<std::size_t> visible = world.visible();
    if (visible.empty()) return {};
    const auto& air = visible.size() > 1 ? world.air : world.light[visible.front()].air;
    const phase::ScatteringMedium& medium = world.instances[visible.front()].medium;
    const auto isSame = [&](std::size_t i) {
        const phase::ScatteringMedium& other = world.instances[i].medium;
        return other.albedo == medium.albedo && other.tables.axisTable == medium.tables.axisTable;
    };
    if (!air || air->cells.empty() || !photon::returnsSky(medium) || !std::ranges::all_of(visible, isSame)) return {};
    return photon::makeSkyReturn(*air, medium);
}

void findLightOfClouds(World& world) {
    updateFogLight(world);
    if (world.fogLight) return findFogLightInClouds(world);
    const sky::Atmosphere* atmosphere = world.lights.environment.atmosphere();
    const bool many = world.visible().size() > 1;
    world.lights.chooseDirect(world.bounds.centre);
    const scene::Sun& direct = world.lights.direct();
    for (std::size_t i = 0; i < world.instances.size(); ++i) {
        const cloud::Instance& instance = world.instances[i];
        light::InstanceLight& light = world.light[i];
        light.sun = world.lights.sunAt(instance.bounds.centre, world.fog);
        if (atmosphere == nullptr || instance.asset == nullptr) continue;
        const photon::Box box = boxOf(instance);
        light.air = photon::makeAirLight(*atmosphere, many ? nullptr : &skyMapsOf(world, box), direct, box);
        light.sun.irradiance = direct.irradiance * sunThroughFog(world, instance) * light.air->mostSun;
        light.air->sunAbove = glm::max(world.lights.sun.irradiance, direct.irradiance);
    }
    if (const sky::MapSky* map = world.lights.environment.map()) return findMapLight(world, *map);
    if (atmosphere == nullptr || !many) return;
    const photon::Box all = boxOfAll(world);
    world.air = photon::makeAirLight(*atmosphere, &skyMapsOf(world, all), direct, all);
    world.air->sunAbove = glm::max(world.lights.sun.irradiance, direct.irradiance);
}

}  // namespace

void findReachingLight(World& world) {
    findLightOfClouds(world);
    findSkyReturn(world);
}

void findSkyReturn(World& world) {
    world.skyReturn = skyReturnIn(world);
}

void placeInstances(World& world) {
    const std::vector<std::size_t> visible = world.visible();
    if (world.photons && visible.size() > 1) world.photons->place(placements(world, visible));
}

bool traceAll(World& world, const CutOff& cutOff, const photon::Ground* ground) {
    if (world.photons) {
        const std::vector<std::size_t> visible = world.visible();
        const cloud::Instance& first = world.instances[visible.front()];
        const light::InstanceLight& only = world.light[visible.front()];
        scene::Sun sun = world.lights.direct();
        const photon::AirLight* air = only.air ? &*only.air : nullptr;
        if (visible.size() > 1) {
            placeInstances(world);
            air = world.air ? &*world.air : nullptr;
            if (air != nullptr) sun.irradiance *= air->mostSun;
        } else {
            sun = only.sun;
        }
        const glm::dvec3 corner = visible.size() > 1 ? world.photons->corner() : first.origin + first.offset;
        if (world.meshHeights && world.lights.hasSun())
            world.photons->setMeshes(world.meshHeights(world.photons->cellsToWorld(), corner));
        if (ground != nullptr) {
            photon::Ground below = *ground;
            below.corner = corner;
            world.photons->setGround(below);
        }
        if (!world.photons->tryTrace(sun, world.lights.environment, cutOff, first.medium.extinction, air)) return false;
        world.photons->keep();
    }
    for (light::InstanceLight& light : world.light) light.changed();
    return true;
}

}  // namespace lumulus
