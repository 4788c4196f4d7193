#pragma once

#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <string_view>

#include "render/gpu_work.h"
#include "render/scene_changes.h"
#include "render/world.h"

/// What changes while a world lives. All owners of what changes are in the world.
namespace lumulus {

/// Where a cloud of the world is in the list: by its name, or by its index. Errors: InputError naming both.
std::size_t findInstance(const World& world, std::string_view cloud);

/// Returns whether anything changed. Errors: InputError where the world was made without a sun.
bool setSun(World& world, const glm::dvec3& directionTo, const glm::dvec3& irradiance);
/// Extinction of a cloud, or of all, as in the scene [1/m]. Returns whether anything changed.
/// Errors: InputError where it is 0, or where nothing is there to be extinct.
bool setExtinction(World& world, double extinction, std::optional<std::size_t> cloud);
/// Moves a cloud, or all, from where the scene has them [m].
void setOffset(World& world, const glm::dvec3& offset, std::optional<std::size_t> cloud);

/// `moved`: ways of clouds that do not lie where the scene has them [m]. `otherFog`: the fog is not the scene's.
SceneChanges changesOf(const World& world, const std::map<std::size_t, glm::dvec3>& moved, bool otherFog);
/// Sun and extinctions of another world of as many clouds; those of clouds in which there is nothing stay. Returns
/// whether anything changed. Errors: those of setSun().
bool takeLight(World& world, const SceneChanges& changes);

/// Coarseness of the shadow volumes that are shown: the largest reduction; 1: all are whole, 0: one has to be made.
int shadowReduction(const World& world);
/// Completes `share` (0 to 1) of the shadow volumes that the last picture used at a reduced resolution. Returns true
/// when nothing is missing.
bool sharpenShadows(GpuWork& work, World& world, double share);

}  // namespace lumulus
