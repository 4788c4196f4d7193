#pragma once

#include "scene/scene.h"

namespace lumulus::progressive {

/// relMSE that stays however many photons there are, from truncated harmonics, the cut forward peak and the resolution
/// of collectors and light field: the sum of the largest that were measured over cumulus scenes (docs/error-time.md, by
/// scripts/bias_table.py). Thin clouds have less.
double biasEstimate(const scene::Scene& scene);

}  // namespace lumulus::progressive
