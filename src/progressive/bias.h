#pragma once

#include <cstdint>

#include "scene/scene.h"

namespace lumulus::progressive {

/// relMSE that is no noise, from truncated harmonics, the cut forward peak and the resolution of collectors and light
/// field, which are finer where there are more `photons`: the sum of the largest that were measured over cumulus scenes
/// (docs/error-time.md, by the study bias_table). Thin clouds have less.
double biasEstimate(const scene::Scene& scene, std::uint64_t photons);

}  // namespace lumulus::progressive
