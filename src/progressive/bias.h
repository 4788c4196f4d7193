#pragma once

#include <cstdint>

#include "scene/scene.h"

namespace lumulus::progressive {

/// Estimates the relMSE that more photons do not lower: truncated harmonics, the forward cut, and the resolution of
/// collectors and light field, which is finer with more `photons`. It is the sum of the largest values measured over
/// cumulus scenes (docs/experiments/stated-bias.md). Thin clouds have less.
double biasEstimate(const scene::Scene& scene, std::uint64_t photons);

}  // namespace lumulus::progressive
