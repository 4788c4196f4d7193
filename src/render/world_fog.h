#pragma once

#include "fog/lit/lit_fog.h"
#include "render/world.h"

/// The light of fog without clouds, in a world that has fog and light.
namespace lumulus {

/// Makes the light of the fog anew, where the sun or the media have changed. There is none where there is no light or
/// no fog, where a medium is not level, and under a map.
void updateFogLight(World& world);

/// Light in and above the fog of a world that has light of fog.
fog_light::FogSurroundings fogSurroundings(const World& world);

/// The media of the fog and, under an atmosphere, of the air in it, in the order of the layers of their light.
scene::Fog fogWithAir(const World& world);

/// Light of fog, sun and sky in each instance and in all together.
void findFogLightInClouds(World& world);

/// The clouds that throw shadows into fog, for a picture of a camera. Their shadow volumes are up to date.
fog::ShadowCasters shadowCasters(const World& world, const Camera& camera);

}  // namespace lumulus
