#include "render/changes.h"

#include <algorithm>

#include "base/error.h"
#include "render/world_fog.h"

namespace lumulus {

namespace {

/// The clouds that are meant: one, or all in which there is something.
std::vector<std::size_t> meant(const World& world, std::optional<std::size_t> cloud) {
    return cloud ? std::vector<std::size_t>{*cloud} : world.visible();
}

}  // namespace

std::size_t findInstance(const World& world, std::string_view cloud) {
    std::string names;
    for (std::size_t i = 0; i < world.instances.size(); ++i) {
        if (world.instances[i].name == cloud || std::to_string(i) == cloud) return i;
        names += (names.empty() ? "" : ", ") + world.instances[i].name;
    }
    throw InputError("there is no cloud \"" + std::string(cloud) + "\"", "cloud",
                     names.empty() ? "the scene has none" : "name one of: " + names);
}

bool setSun(World& world, const glm::dvec3& directionTo, const glm::dvec3& irradiance) {
    scene::Sun& sun = world.lights.sun;
    if (directionTo == sun.directionTo && irradiance == sun.irradiance) return false;
    if (!world.lights.hasSun() && !world.hasShadows())
        throw InputError("the scene was made without a sun", "sun.irradiance", "load a scene with one");
    if (const sky::MapSky* map = world.lights.environment.map(); map != nullptr && map->sun())
        throw InputError("the sun is that of the sky's map, and cannot move", "sky.map_sun",
                         "load the scene with sky.map_sun = false and a sun.irradiance");
    const glm::dvec3 before = world.lights.direct().directionTo;
    sun.directionTo = directionTo;
    sun.irradiance = irradiance;
    findReachingLight(world);
    if (world.lights.direct().directionTo != before)
        for (light::InstanceLight& light : world.light) light.shadowReduction = 0;
    return true;
}

bool setExtinction(World& world, double extinction, std::optional<std::size_t> cloud) {
    const std::vector<std::size_t> clouds = meant(world, cloud);
    if (clouds.empty() || !(extinction > 0.0) || world.instances[clouds.front()].asset == nullptr)
        throw InputError("an extinction of 0 cannot be changed or reached", "extinction", "load another scene");
    bool changed = false;
    for (const std::size_t i : clouds) {
        cloud::Instance& instance = world.instances[i];
        light::InstanceLight& light = world.light[i];
        if (extinction == instance.sceneExtinction) continue;
        instance.medium.extinction *= extinction / instance.sceneExtinction;
        instance.sceneExtinction = extinction;
        light.changed();
        light.shadowReduction = 0;
        changed = true;
    }
    return changed;
}

void setOffset(World& world, const glm::dvec3& offset, std::optional<std::size_t> cloud) {
    for (const std::size_t i : meant(world, cloud)) world.instances[i].offset = offset;
    placeInstances(world);
}

SceneChanges changesOf(const World& world, const std::map<std::size_t, glm::dvec3>& moved, bool otherFog) {
    SceneChanges changes{world.lights.sun, {}, world.wind, moved, {}};
    if (otherFog) changes.fog = std::make_shared<const NewFog>(fogOf(world));
    for (const cloud::Instance& instance : world.instances) changes.extinctions.push_back(instance.sceneExtinction);
    return changes;
}

bool takeLight(World& world, const SceneChanges& changes) {
    const scene::Sun& sun = world.lights.sun;
    bool changed = false;
    if (changes.sun.directionTo != sun.directionTo || changes.sun.irradiance != sun.irradiance)
        changed = setSun(world, changes.sun.directionTo, changes.sun.irradiance);
    for (std::size_t i = 0; i < changes.extinctions.size(); ++i)
        if (world.instances.at(i).asset != nullptr && changes.extinctions[i] > 0.0)
            changed = setExtinction(world, changes.extinctions[i], i) || changed;
    return changed;
}

int shadowReduction(const World& world) {
    int largest = 1;
    for (const light::InstanceLight& light : world.light) {
        if (light.shadow && light.shadowReduction == 0) return 0;
        if (light.shadow) largest = std::max(largest, light.shadowReduction);
    }
    return largest;
}

bool sharpenShadows(GpuWork& work, World& world, double share) {
    for (std::size_t i = 0; i < world.light.size(); ++i) {
        light::InstanceLight& light = world.light[i];
        if (!light.shadow || light.shadowReduction <= 1) continue;
        if (!light.sharpening) light.shadow->begin(-light.sun.directionTo, world.instances[i].medium.extinction);
        light.sharpening = true;
        work.run([&](gpu::Commands& commands) {
            if (!light.shadow->recordPart(commands, share)) return;
            light.shadowReduction = 1;
            ++light.shadowVersion;
            light.sharpening = false;
        });
        return shadowReduction(world) == 1;
    }
    return true;
}

}  // namespace lumulus
