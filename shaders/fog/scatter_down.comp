#version 460
#extension GL_GOOGLE_include_directive : require
// Down the scattering pyramid: light that the finer level has passed on, split again.
#include "shared/fog.h"
#include "lib/fog_split.glsl"
#include "lib/pyramid.glsl"

layout(local_size_x = 16, local_size_y = 4) in;
layout(constant_id = 0) const int PAIRS = 2;  // half the taps across
layout(constant_id = 1) const float STEP_VARIANCE = 2.1;
layout(binding = 0) uniform sampler2D passedFiner;
layout(binding = 1) uniform writeonly image2D kept;
layout(binding = 2) uniform writeonly image2D halfway;
layout(binding = 3) uniform writeonly image2D passed;
layout(push_constant, scalar) uniform Push { LevelPush push; };

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, push.coarserSize))) return;
    const vec4 arrived = reduced(passedFiner, push, pixel, PAIRS);
    const float weight = luminance(arrived.rgb);
    const float spread = weight > 1.0e-30 ? arrived.a / weight : 0.0;
    const SplitLight split = splitLight(arrived.rgb, spread, push.level, push.last, STEP_VARIANCE);
    const ivec2 target = push.coarserOffset + pixel;
    imageStore(kept, target, vec4(split.kept, 1.0));
    imageStore(halfway, target, vec4(split.halfway, 1.0));
    imageStore(passed, target, split.passed);
}
