#pragma once

#include "base/interrupt.h"
#include "scene/scene.h"

namespace lumulus {

/// The scene with a cloud for each part of a file whose parts lie so far apart that a box round all of them is next to
/// empty: NAME[0], NAME[1] and so on, as placeClouds() names instances, each with a box of its own. Together they are
/// the same density, and cost what clouds of files of their own cost. Files of sequences, and those that cannot be
/// read, stay as they are: who loads them tells what is wrong. Clouds must be placed. Errors: what `check` throws.
scene::Scene divideFarParts(scene::Scene scene, const Check& check = stopIfInterrupted);

}  // namespace lumulus
