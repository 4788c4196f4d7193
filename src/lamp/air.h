#pragma once

#include "scene/fog.h"
#include "sky/air.h"

namespace lumulus::lamp {

/// The fog of a scene with the air above a ground at that height of the world (metres) as two more media, molecules and
/// aerosol, as lamps light them: by the mean of the four wavelengths that makes each channel of Rec. 709. That is right
/// where the air dims the light little, up to some tens of kilometres. Ozone, which is high above all lamps, is left
/// out; the phase function of molecules is even.
scene::Fog withAir(scene::Fog fog, const sky::Air& air, double groundHeight);

}  // namespace lumulus::lamp
