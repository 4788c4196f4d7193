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

/// Whether the light of a world's fog is that of its media.
bool isUpToDate(World& world) {
    const FogLights lights = fogLightsOf(world);
    const std::optional<Layers> layers = litLayers(world.fog, lights.ground);
    return layers && isLightOf(world, lights, *layers);
}

void take(World& world, const NewFog& fog) {
    world.fogLight = fog.light;
    world.airOverFog = fog.air;
    ++world.fogVersion;
}

using Boxes = std::vector<std::optional<photon::Box>>;

Boxes boxesOf(const World& world) {
    Boxes boxes;
    for (const cloud::Instance& instance : world.instances)
        boxes.push_back(instance.asset == nullptr
                            ? std::nullopt
                            : std::optional(photon::Box{instance.origin + instance.offset, instance.voxelToMetres,
                                                        glm::dvec3(instance.asset->size)}));
    return boxes;
}

bool areSame(const Boxes& a, const Boxes& b) {
    return std::ranges::equal(a, b, [](const auto& one, const auto& other) {
        if (!one || !other) return !one && !other;
        return one->origin == other->origin && one->edges == other->edges && one->size == other->size;
    });
}

FogInClouds lightInClouds(const fog_light::FogSurroundings& fog, const scene::Sun& direct, const Boxes& boxes) {
    FogInClouds light{boxes, {}, {}};
    const bool many = std::ranges::count_if(boxes, [](const auto& box) { return box.has_value(); }) > 1;
    glm::dvec3 lower(std::numeric_limits<double>::infinity()), upper = -lower;
    for (const std::optional<photon::Box>& box : boxes) {
        std::optional<photon::AirLight>& each = light.each.emplace_back();
        if (!box) continue;
        each = photon::makeFogAirLight(fog, !many, direct, *box);
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 at(corner & 1, (corner >> 1) & 1, corner >> 2);
            const glm::dvec3 point = box->origin + box->edges * (at * box->size);
            lower = glm::min(lower, point), upper = glm::max(upper, point);
        }
    }
    if (many)
        light.all = photon::makeFogAirLight(fog, true, direct, photon::Box{lower, glm::dmat3(1.0), upper - lower});
    return light;
}

void put(World& world, FogInClouds found) {
    for (std::size_t i = 0; i < world.instances.size(); ++i) {
        if (!found.each[i]) continue;
        light::InstanceLight& light = world.light[i];
        light.air = std::move(found.each[i]);
        light.sun = world.lights.direct();
        light.sun.irradiance *= light.air->mostSun;
    }
    if (found.all) world.air = std::move(found.all);
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
    const FogLights shining = fogLightsOf(world);
    return [lights = shining, direct = world.lights.direct(), boxes = boxesOf(world), fog = world.fog, isLit,
            staysDark](std::vector<scene::FogMedium> media, const Check& check) {
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
        check();
        if (isLit) made.inClouds = lightInClouds({*made.light, made.air.get()}, direct, boxes);
        made.media = std::move(wanted.media);
        return std::make_shared<const NewFog>(std::move(made));
    };
}

bool setFog(World& world, const NewFog& fog) {
    if (fog.media == world.fog.media) return false;
    world.fog.media = fog.media;
    take(world, fog);
    if (fog.inClouds && areSame(fog.inClouds->boxes, boxesOf(world)) && isUpToDate(world)) {
        put(world, *fog.inClouds);
        findSkyReturn(world);
    } else {
        findReachingLight(world);
    }
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
    put(world, lightInClouds(fogSurroundings(world), world.lights.direct(), boxesOf(world)));
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
