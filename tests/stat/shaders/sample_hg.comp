#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/phase.h"
#include "shared/rng.h"
#include "sample_hg.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { SampleHgPush push; };
layout(binding = 0, scalar) writeonly buffer Turns { SampledDirection turns[]; };

void main() {
    const uint index = gl_GlobalInvocationID.x;
    if (index >= push.count) return;
    const vec4 u = rngUniform4(uvec4(index, 0u, 0u, push.stream));
    const ScatterAngle angle = sampleHg(push.g, u.x, push.scatterFraction);
    turns[index].uniform4 = u;
    turns[index].angle = vec3(angle.oneMinusCos, angle.onePlusCos, angle.sinTheta);
    turns[index].to = rotateDirection(push.from, angle, 6.28318531 * u.y);
}
