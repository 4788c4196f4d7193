#include "render/world_fog.h"

#include <algorithm>
#include <limits>

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

/// The same under an atmosphere, whose planet the fog stands on.
void updateFogInAir(World& world, std::vector<fog_light::FogLayer> layers) {
    light::LightSet& lights = world.lights;
    lights.chooseDirect(world.bounds.centre);
    fog_light::AirLights shining{lights.direct()};
    if (lights.environment.moon())
        shining.other = &lights.direct() == &lights.sun ? *lights.environment.moon() : lights.sun;
    const double highest = highestOf(world);
    if (world.airOverFog && world.airOverFog->isOf(shining, layers, highest)) return;
    world.fogLight.reset();  // it asks the air
    world.airOverFog = std::make_unique<const fog_light::AirOverFog>(*lights.environment.atmosphere(), shining, layers,
                                                                     lights.planet->albedo, highest);
    for (const fog_light::FogLayer& air : world.airOverFog->layers()) layers.push_back(air);
    world.fogLight.emplace(layers, world.airOverFog->setting());
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
    const std::optional<std::vector<fog_light::FogLayer>> layers = fog_light::layersOf(world.fog);
    const fog_light::FogSetting setting = settingOf(world.lights);
    if (!layers || fog_light::levelsOf(*layers, setting.groundHeight).empty()) return;
    if (world.lights.environment.atmosphere() != nullptr) return updateFogInAir(world, *layers);
    if (world.fogLight && world.fogLight->layers() == *layers && world.fogLight->setting().isSame(setting)) return;
    world.fogLight.emplace(*layers, setting);
    ++world.fogVersion;
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
