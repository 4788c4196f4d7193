#pragma once

#include "sky/optical_depth.h"

namespace lumulus::sky {

/// Share of a disc of angular radius `radius` that the ground leaves visible at a height, for a disc whose middle
/// stands at this cosine to the upward direction. `middle` becomes the cosine of the middle of what is visible.
double visibleShare(double height, double up, double radius, double& middle);

/// Transmittance of the air from a point to the sun's disc, with the part of it that the ground hides.
Spectrum sunTransmittance(const Air& air, const ColumnTable& columns, double height, double up, double radius);

}  // namespace lumulus::sky
