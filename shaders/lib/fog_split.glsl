// The scattering pyramid: a level keeps the light whose spread is its own and passes the rest on. Between two levels
// stands a half step, the coarser filter of which is a 3×3 binomial at the finer level's resolution: kernels a factor √2
// apart make a Gaussian of any width far better than those of the levels alone. Shares are linear in the variance, so
// that the variance of what arrives is right.
#ifndef LUMULUS_LIB_FOG_SPLIT
#define LUMULUS_LIB_FOG_SPLIT

#include "shared/fog.h"

struct SplitLight {
    vec3 kept;
    vec3 halfway;
    vec4 passed;  // alpha: luminance · spread
};

/// Light of the standard deviation `spread` [pixels of the picture] at a level.
SplitLight splitLight(vec3 light, float spread, int level, int last, float stepVariance) {
    const float variance = spread * spread;
    const float here = levelVariance(stepVariance, level), next = levelVariance(stepVariance, level + 1);
    const float middle = here + 0.5 * pow(4.0, float(level));
    const float kept = clamp((middle - variance) / (middle - here), 0.0, 1.0);
    const float beyond = level == last ? 0.0 : clamp((variance - middle) / (next - middle), 0.0, 1.0);
    SplitLight split;
    split.kept = kept * light;
    split.halfway = (1.0 - kept) * (1.0 - beyond) * light;
    split.passed.rgb = beyond * light;
    split.passed.a = luminance(split.passed.rgb) * max(spread, sqrt(next));
    return split;
}

#endif
