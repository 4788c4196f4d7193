#pragma once

#include "base/image.h"

namespace lumulus::service {

/// The relMSE (mean of Δ²/(R² + 0.01·mean(R)²)) that the noise of `later` has, a mean over `laterCount` generations of
/// which `earlier` shows the first `earlierCount`: the variance of their difference is σ²(1/n₁ − 1/n₂), that of `later`
/// σ²/n₂. Over pixels with cloud; 0 where there are none. Needs earlierCount < laterCount.
double nestedNoise(const LayeredImage& earlier, int earlierCount, const LayeredImage& later, int laterCount);

}  // namespace lumulus::service
