#pragma once

#include "render/gpu_work.h"
#include "render/view_state.h"
#include "render/world.h"

namespace lumulus {

/// Makes the light in all instances as a view sees it, as far as it is not up to date: shadow volumes, the collectors'
/// radiance towards the eye, light fields. `bands` of the photon map; `shadowReduction` as allowSunReduction().
/// With a part of the generations it is always made anew, and not up to date afterwards.
void lightView(GpuWork& work, World& world, ViewState::State& view, photon::Part part, int bands, int shadowReduction);

/// Makes the shadow volumes of all instances, as far as they are not up to date.
void makeShadows(GpuWork& work, World& world, int reduction);

/// The eye of a camera in the voxel coordinates of an instance. An orthographic eye is far away: all collectors see it
/// in one direction.
glm::vec3 eyeVoxel(const cloud::Instance& instance, const Camera& camera);

}  // namespace lumulus
