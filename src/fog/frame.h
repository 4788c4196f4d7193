#pragma once

#include "base/image.h"
#include "fog/fog.h"

namespace lumulus::fog {

/// Shows a drawn frame (layers as draw::skyImage makes them) through the fog, in place. A frame is two layers: the
/// cloud at its mean distance, with how much it covers, and the sky behind it; each is filtered by itself. What is
/// approximated: a cloud scatters and is dimmed as if it stood at one distance in each pixel. R, G, B and cloud.R, G, B
/// change, the other layers do not.
void applyToFrame(Fog& fog, LayeredImage& image, const Camera& camera);

}  // namespace lumulus::fog
