#pragma once

#include <span>

#include "base/tonemap.h"
#include "scene/scene.h"

namespace lumulus::scene {

/// How the pictures of a scene, all together, become pictures of 8 bits. With the exposure mode `auto` their gain is
/// what a meter of their own gives (base/exposure.h); they are not looked at in the other modes.
Tone toneOf(const Image& image, std::span<const LayeredImage* const> pictures);

}  // namespace lumulus::scene
