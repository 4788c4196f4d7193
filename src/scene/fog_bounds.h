#pragma once

#include "scene/scene.h"

/// Where fog ends. Light of sun and sky that comes through endless fog has no meaning.
namespace lumulus::scene {

/// Whether the relative density of a medium has a finite integral along every vertical line.
bool isBounded(const FogMedium& medium);

/// Whether the medium is level: its density depends on the height alone.
bool isLevel(const FogMedium& medium);

/// Ends a level layer at the ground's height.
void endAtGround(FogMedium& medium, double height);

/// Refuses a scene in which light of a sun, of a sky or of the fog itself goes through a medium that is not bounded.
/// Errors: InputError.
void requireBoundedFog(const Scene& scene);

}  // namespace lumulus::scene
