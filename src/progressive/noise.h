#pragma once

#include "render/renderer.h"

namespace lumulus::progressive {

/// The relMSE that the photons' noise alone makes in a picture of all `generations` traced: the two halves have no
/// photons in common, so that they differ by noise only, mean (A−B)² · nA·nB/((nA+nB)·n) / (R² + .01·mean(R)²) over the
/// pixels and channels where the cloud's transmittance is below .999, with R the picture of both halves. 0 where there
/// is no such pixel, or where all light of the scene misses the cloud.
double noiseOf(const Preview& preview, int generations);

}  // namespace lumulus::progressive
