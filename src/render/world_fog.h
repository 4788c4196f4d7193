#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "fog/lit/lit_fog.h"
#include "render/new_fog.h"
#include "render/world.h"

/// The light of fog without clouds, in a world that has fog and light.
namespace lumulus {

/// Makes the light of the fog anew, where the sun or the media have changed. There is none where there is no light or
/// no fog, where a medium is not level, and under a map.
void updateFogLight(World& world);

/// Lets a world begin with the light of fog of another one, which serves where sun and media are the same.
void shareFogLight(World& world, const World& other);

/// Light of fog in clouds, which lie in these boxes.
struct FogInClouds {
    std::vector<std::optional<photon::Box>> boxes;  ///< of all instances; none where there is nothing
    std::vector<std::optional<photon::AirLight>> each;
    std::optional<photon::AirLight> all;  ///< where there are several
};

struct NewFog {
    std::vector<scene::FogMedium> media;
    std::shared_ptr<const fog_light::AirOverFog> air{};  ///< null where the fog is in none
    std::shared_ptr<const fog_light::FogLight> light{};  ///< null where it is not lit (World::fogLight)
    std::optional<FogInClouds> inClouds{};
};

/// Finds other fog for a world that has fog, or refuses it where what the world was made for would not do: a scene
/// without fog, or fog that is lit in the place of fog that is not. Errors, besides FogMaker's: InputError.
FogMaker fogMaker(World& world);
/// The fog of a world as it is now.
NewFog fogOf(const World& world);
/// Puts other fog in the place of a world's. Where sun or clouds have changed since it was made, its light is made
/// anew, which takes as long; where clouds have moved, that in them. Returns whether anything changed.
bool setFog(World& world, const NewFog& fog);

/// Light in and above the fog of a world that has light of fog.
fog_light::FogSurroundings fogSurroundings(const World& world);

/// The media of the fog and, under an atmosphere, of the air in it, in the order of the layers of their light.
scene::Fog fogWithAir(const World& world);

/// Light of fog, sun and sky in each instance and in all together.
void findFogLightInClouds(World& world);

/// Finds the light of the sky that goes to and fro along rays, from the light in all instances.
void findSkyReturn(World& world);

/// The clouds that throw shadows into fog, for a picture of a camera. Their shadow volumes are up to date.
fog::ShadowCasters shadowCasters(const World& world, const Camera& camera);

}  // namespace lumulus
