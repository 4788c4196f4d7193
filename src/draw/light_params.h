#pragma once

#include "scene/scene.h"
#include "shared/draw.h"

namespace lumulus::draw {

/// The sun as the eye sees it; its irradiance is that outside of all fog and air.
shared::LightParams lightParams(const scene::Sun& sun);

}  // namespace lumulus::draw
