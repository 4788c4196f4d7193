#pragma once

#include "render/renderer.h"

namespace lumulus::progressive {

/// Estimates the relMSE of the photons' noise in a picture of all `generations`. The split sums of even and odd
/// generations share no photon, so their pictures A and B differ by noise only: the mean of (A−B)² · nA·nB/((nA+nB)·n)
/// / (R² + 0.01·mean(R)²) over the pixels and channels where the cloud's transmittance is below 0.999; R is the picture
/// of both sums. Returns 0 if there is no such pixel, or if all light of the scene misses the cloud.
double noiseOf(const Preview& preview, int generations);

}  // namespace lumulus::progressive
