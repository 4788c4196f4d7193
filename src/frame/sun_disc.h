#pragma once

#include <vector>

#include "shared/frame.h"
#include "sky/atmosphere.h"
#include "view/camera.h"
#include "view/view.h"

namespace lumulus::frame {

/// The pixels of the part `tile` that see the sun's disc, counted from its corner, with the radiance that the disc adds
/// to them: its mean over the pixel's solid angle, as nothing but the air and the ground of an atmosphere were in the
/// way.
std::vector<shared::SunPixel> sunPixels(const Camera& camera, const Tile& tile, const scene::Sun& sun,
                                        const sky::Atmosphere* air = nullptr);

/// Radiance of the sun's disc against its mean, at `place` of its radius from its middle (Cox 2000).
double limbDarkening(double place);

}  // namespace lumulus::frame
