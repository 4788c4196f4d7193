#pragma once

#include "scene/scene.h"

namespace lumulus::progressive {

/// relMSE that stays however many photons there are, from truncated harmonics, the cut forward peak and the resolution
/// of collectors and light field: the largest that was measured over the cumulus scenes with these bands, this cut (off
/// or on) and this way to draw (docs/error-time.md, by scripts/bias_table.py). Thin clouds have less.
double biasEstimate(const scene::Scene& scene);

}  // namespace lumulus::progressive
