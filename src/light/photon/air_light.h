#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "light/fog_light/air_over_fog.h"
#include "shared/air_light.h"
#include "sky/map_sky.h"
#include "sky/sky_maps.h"

namespace lumulus::photon {

/// Light in one cloud of surroundings that differ by direction or by height: of an atmosphere, of fog, or of a map,
/// whose sun is the same everywhere.
struct AirLight {
    shared::AirPlace place{};            ///< of voxels
    std::vector<glm::vec3> sunColours;   ///< against `mostSun`: SUN_COLOUR_ROWS by SUN_COLOUR_COLUMNS
    glm::dvec3 mostSun{0.0};             ///< largest transmittance to the sun within the cloud, by channel
    std::vector<shared::SkyCell> cells;  ///< of the sky
    /// In fog, which changes light by height: what photons from each cell weigh for each m², at FOG_SKY_HEIGHTS heights
    /// [height][cell]; then, for each height, the depth of the fog between it and the ground.
    std::vector<glm::vec3> fogSky;
    glm::dvec3 skyFlux{0.0};      ///< of sky and ground through the cloud's box [W]
    double skyPeak = 1.0;         ///< largest weight of a photon of the sky
    double skyPeakDensity = 0.0;  ///< largest weight for each m² that a photon stands for
    double meanArea = 0.0;        ///< that the box shows, on average over directions [m²]
    glm::dvec3 origin{0.0};       ///< of the voxels that `place` is of [m]
    glm::dvec3 sunAbove{0.0};     ///< irradiance of the sun above the air: no light in the cloud has more
    sky::SkyCells skyFrame;       ///< of `cells`
};

/// The box of a cloud in the world: voxel (0,0,0) lies at `origin`, `edges` are those of a voxel [m].
struct Box {
    glm::dvec3 origin{0.0};
    glm::dmat3 edges{1.0};
    glm::dvec3 size{1.0};  ///< voxels
};

/// Heights above the ground between which a box lies [m].
glm::dvec2 heightsOf(const sky::Atmosphere& atmosphere, const Box& box);

/// Light of an atmosphere in a cloud: of the sun and, with the maps of its sky, of the sky.
AirLight makeAirLight(const sky::Atmosphere& atmosphere, const sky::SkyMaps* maps, const scene::Sun& sun,
                      const Box& box);

/// Light of fog in a cloud: of the sun and, where `withSky`, of sky, fog and ground. `sun` is above air and fog.
AirLight makeFogAirLight(const fog_light::FogSurroundings& fog, bool withSky, const scene::Sun& sun, const Box& box);
/// Light of a map in a cloud.
AirLight makeMapLight(const sky::MapSky& map, const scene::Sun& sun, const Box& box);

/// The same light for photons that stand for areas up to `area` [m²] instead of those that the box shows, and for
/// places in metres from `origin`. The voxels of `light` are metres along the axes of the world.
AirLight forArea(const AirLight& light, double area, const glm::dvec3& origin);

}  // namespace lumulus::photon
