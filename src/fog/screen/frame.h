#pragma once

#include "base/image.h"
#include "fog/screen/fog.h"

namespace lumulus::fog {

/// Shows a drawn frame (layers as frame::skyImage makes them) through the fog, in place: R, G, B and cloud.R, G, B
/// change. The cloud is a layer at its mean distance, with how much it covers. A sky that is the same everywhere stays
/// so in fog, but for what is absorbed; what differs from `skyRadiance` is filtered as a layer behind all fog: light
/// that the cloud takes out of the sky, and the sun's disc. What is approximated: in each pixel a cloud stands at one
/// distance.
void applyToFrame(Fog& fog, LayeredImage& image, const Camera& camera, const glm::dvec3& skyRadiance);

}  // namespace lumulus::fog
