#include "render/world_fog.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "base/error.h"
#include "scene/fog_bounds.h"

namespace lumulus {

namespace {

fog_light::FogSetting settingOf(const light::LightSet& lights) {
    fog_light::FogSetting setting;
    setting.toSun = lights.sun.directionTo;
    setting.sun = lights.sun.irradiance;
    setting.sky = lights.constantSky();
    if (const auto& ground = lights.planet ? lights.planet : lights.ground) {
        setting.groundHeight = ground->height;
        setting.groundAlbedo = ground->albedo;
    }
    return setting;
}

/// Rows of a matrix, each with a part of an offset.
void addRows(std::vector<glm::vec4>& texels, const glm::mat3& matrix, const glm::vec3& offset) {
    for (int row = 0; row < 3; ++row) texels.emplace_back(matrix[0][row], matrix[1][row], matrix[2][row], offset[row]);
}

/// The highest point of all clouds.
double highestOf(const World& world) {
    double highest = -std::numeric_limits<double>::infinity();
    for (const std::size_t i : world.visible()) {
        const cloud::Instance& instance = world.instances[i];
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 at(corner & 1, (corner >> 1) & 1, corner >> 2);
            const glm::dvec3 point = instance.voxelToMetres * (at * glm::dvec3(instance.asset->size));
            highest = std::max(highest, instance.origin.y + instance.offset.y + point.y);
        }
    }
    return highest;
}

using Layers = std::vector<fog_light::FogLayer>;

/// What lights level fog, whatever its media are.
struct FogLights {
    fog_light::FogSetting setting;  ///< without an atmosphere
    sky::Environment environment;
    fog_light::AirLights shining;       ///< in an atmosphere
    glm::dvec3 groundAlbedo{0.0};       ///< of its planet
    double highest = 0.0;               ///< of the clouds, there
    std::optional<double> ground = {};  ///< height of what is below

    const sky::Atmosphere* atmosphere() const { return environment.atmosphere(); }
};

FogLights fogLightsOf(World& world) {
    light::LightSet& lights = world.lights;
    FogLights result{settingOf(lights), lights.environment, {}};
    result.ground = result.setting.groundHeight;
    if (result.atmosphere() == nullptr) return result;
    lights.chooseDirect(world.bounds.centre);
    result.shining.direct = lights.direct();
    if (lights.environment.moon())
        result.shining.other = &lights.direct() == &lights.sun ? *lights.environment.moon() : lights.sun;
    result.groundAlbedo = lights.planet->albedo;
    result.highest = highestOf(world);
    return result;
}

/// Whether the light of a world's fog is that of these.
bool isLightOf(const World& world, const FogLights& lights, const Layers& layers) {
    if (!world.fogLight) return false;
    if (lights.atmosphere() != nullptr)
        return world.airOverFog && world.airOverFog->isOf(lights.shining, layers, lights.highest);
    return world.fogLight->layers() == layers && world.fogLight->setting().isSame(lights.setting);
}

/// Fog in an atmosphere stands on its planet.
NewFog lightIn(const FogLights& lights, Layers layers, const Check& check) {
    NewFog made;
    if (lights.atmosphere() == nullptr) {
        made.light = std::make_shared<const fog_light::FogLight>(layers, lights.setting, check);
        return made;
    }
    made.air = std::make_shared<const fog_light::AirOverFog>(*lights.atmosphere(), lights.shining, layers,
                                                             lights.groundAlbedo, lights.highest, check);
    for (const fog_light::FogLayer& air : made.air->layers()) layers.push_back(air);
    made.light = std::make_shared<const fog_light::FogLight>(layers, made.air->setting(), check);
    return made;
}

/// The media as layers that sun and sky light, above such a ground; none where they are not.
std::optional<Layers> litLayers(const scene::Fog& fog, const std::optional<double>& ground) {
    std::optional<Layers> layers = fog_light::layersOf(fog);
    if (layers && fog_light::levelsOf(*layers, ground).empty()) layers.reset();
    return layers;
}

void take(World& world, const NewFog& fog) {
    world.fogLight = fog.light;
    world.airOverFog = fog.air;
    ++world.fogVersion;
}

scene::FogMedium mediumOf(const fog_light::FogLayer& layer) {
    scene::FogMedium medium;
    medium.kind = scene::MediumKind::exponential;
    medium.scattering = layer.scattering;
    medium.absorption = layer.absorption;
    medium.g = layer.g;
    medium.falloff = layer.falloff;
    medium.offset.y = layer.offset;
    medium.bottom = layer.bottom;
    medium.top = layer.top;
    return medium;
}

}  // namespace

void updateFogLight(World& world) {
    const bool wanted = world.fogLight || !world.lights.isDark();
    if (world.fog.media.empty() || world.lights.environment.map() != nullptr || !wanted) return;
    const FogLights lights = fogLightsOf(world);
    const std::optional<Layers> layers = litLayers(world.fog, lights.ground);
    if (!layers || isLightOf(world, lights, *layers)) return;
    take(world, lightIn(lights, *layers, stopIfInterrupted));
}

void shareFogLight(World& world, const World& other) {
    take(world, fogOf(other));
}

NewFog fogOf(const World& world) {
    return {world.fog.media, world.airOverFog, world.fogLight};
}

FogMaker fogMaker(World& world) {
    if (world.fog.media.empty())
        throw InputError("the scene was made without fog", "fog.media", "load it with a medium");
    const bool isLit = world.fogLight != nullptr;
    const bool staysDark = world.lights.isDark() || world.lights.environment.map() != nullptr;
    return [lights = fogLightsOf(world), fog = world.fog, isLit, staysDark](std::vector<scene::FogMedium> media,
                                                                            const Check& check) {
        scene::Fog wanted = fog;
        for (scene::FogMedium& medium : media)
            if (lights.ground) scene::endAtGround(medium, *lights.ground);
        wanted.media = std::move(media);
        const std::optional<Layers> layers = litLayers(wanted, lights.ground);
        if (isLit && !layers)
            throw InputError("no level fog would be left, in which sun and sky have their light", "fog.media",
                             "load the scene with these media");
        if (!isLit && layers && !staysDark)
            throw InputError("the fog would be level, and have light of sun and sky, as it has not now", "fog.media",
                             "load the scene with these media");
        NewFog made = isLit ? lightIn(lights, *layers, check) : NewFog();
        made.media = std::move(wanted.media);
        return std::make_shared<const NewFog>(std::move(made));
    };
}

bool setFog(World& world, const NewFog& fog) {
    if (fog.media == world.fog.media) return false;
    world.fog.media = fog.media;
    take(world, fog);
    findReachingLight(world);
    return true;
}

fog_light::FogSurroundings fogSurroundings(const World& world) {
    return {*world.fogLight, world.airOverFog.get()};
}

scene::Fog fogWithAir(const World& world) {
    scene::Fog fog = world.fog;
    const std::vector<fog_light::FogLayer>& layers = world.fogLight->layers();
    for (std::size_t i = fog.media.size(); i < layers.size(); ++i) fog.media.push_back(mediumOf(layers[i]));
    return fog;
}

void findFogLightInClouds(World& world) {
    const bool many = world.visible().size() > 1;
    glm::dvec3 lower(std::numeric_limits<double>::infinity()), upper = -lower;
    for (std::size_t i = 0; i < world.instances.size(); ++i) {
        const cloud::Instance& instance = world.instances[i];
        if (instance.asset == nullptr) continue;
        light::InstanceLight& light = world.light[i];
        const photon::Box box{instance.origin + instance.offset, instance.voxelToMetres,
                              glm::dvec3(instance.asset->size)};
        light.air = photon::makeFogAirLight(fogSurroundings(world), !many, world.lights.direct(), box);
        light.sun = world.lights.direct();
        light.sun.irradiance *= light.air->mostSun;
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 at(corner & 1, (corner >> 1) & 1, corner >> 2);
            const glm::dvec3 point = box.origin + box.edges * (at * box.size);
            lower = glm::min(lower, point), upper = glm::max(upper, point);
        }
    }
    if (!many) return;
    const photon::Box all{lower, glm::dmat3(1.0), upper - lower};
    world.air = photon::makeFogAirLight(fogSurroundings(world), true, world.lights.direct(), all);
}

fog::ShadowCasters shadowCasters(const World& world, const Camera& camera) {
    fog::ShadowCasters casters;
    const std::vector<std::size_t> visible = world.visible();
    for (std::size_t place = 0; place < visible.size(); ++place) {
        const cloud::Instance& instance = world.instances[visible[place]];
        const std::optional<light::ShadowVolume>& shadow = world.light[visible[place]].shadow;
        if (!shadow) continue;
        addRows(casters.texels, glm::mat3(glm::inverse(instance.voxelToMetres)),
                glm::vec3(instance.toVoxel(camera.position)));
        casters.texels.emplace_back(glm::vec3(instance.asset->size), 0.0F);
        addRows(casters.texels, shadow->voxelToTexture(), shadow->textureOffset());
        const bool many = world.sharedShadow.has_value();
        casters.texels.emplace_back(many ? glm::vec3(world.sharedShadow->origin(place)) : glm::vec3(0.0F), 0.0F);
        casters.texels.emplace_back(glm::vec3(shadow->image().extent()), 0.0F);
        const double straight = static_cast<double>(instance.medium.tables.forwardFraction);
        casters.texels.emplace_back(glm::vec3(1.0 - straight * instance.medium.albedo), 0.0F);
        casters.volumes = many ? &world.sharedShadow->image() : &shadow->image();
        if (many) casters.inverseSize = world.sharedShadow->inverseSize();
    }
    return casters;
}

}  // namespace lumulus
