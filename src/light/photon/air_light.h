#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "shared/air_light.h"
#include "sky/sky_maps.h"

namespace lumulus::photon {

/// Light of an atmosphere in one cloud.
struct AirLight {
    shared::AirPlace place{};            ///< of voxels
    std::vector<glm::vec3> sunColours;   ///< against `mostSun`: SUN_COLOUR_ROWS by SUN_COLOUR_COLUMNS
    glm::dvec3 mostSun{0.0};             ///< largest transmittance to the sun within the cloud, by channel
    std::vector<shared::SkyCell> cells;  ///< of the sky's map
    glm::dvec3 skyFlux{0.0};             ///< of sky and ground through the cloud's box [W]
    double skyPeak = 1.0;                ///< largest weight of a photon of the sky
    glm::dmat3 skyAxes{1.0};             ///< from the map to the world
};

/// The box of a cloud in the world: voxel (0,0,0) lies at `origin`, `edges` are those of a voxel [m].
struct Box {
    glm::dvec3 origin{0.0};
    glm::dmat3 edges{1.0};
    glm::dvec3 size{1.0};  ///< voxels
};

/// Light of an atmosphere, with the maps of its sky, in a cloud.
AirLight makeAirLight(const sky::Atmosphere& atmosphere, const sky::SkyMaps& maps, const scene::Sun& sun,
                      const Box& box);

}  // namespace lumulus::photon
