#version 460
#extension GL_GOOGLE_include_directive : require
// Composition of a filter that gathers: each pixel reads the chain at the level of its own spread (Elek 2013, eq. 10 to
// 12; Iser 2017, eq. 4.23 and 4.28).
#include "shared/fog.h"
#include "lib/pyramid.glsl"

layout(local_size_x = 16, local_size_y = 4) in;
layout(constant_id = 0) const bool MASKED = true;
layout(constant_id = 1) const bool SEPARATE = true;
layout(constant_id = 2) const int FETCH = 1;  // 0 bilinear, 1 linear between levels and bicubic, 2 cubic between levels
layout(binding = 0) uniform sampler2D sharp;
layout(binding = 1) uniform sampler2D scattered;
layout(binding = 2) uniform sampler2D depth;
layout(binding = 3) uniform sampler2D separated;
layout(binding = 4) uniform sampler2D levels;  // a texel each: offset and size
layout(binding = 5) uniform writeonly image2D result;
layout(push_constant, scalar) uniform Push { FetchPush push; };

/// The image `chain` at level `level` (a whole number); `place` in pixels of the finest.
vec4 chainLevel(sampler2D chain, int level, vec2 place) {
    const ivec4 rectangle = ivec4(texelFetch(levels, ivec2(clamp(level, 0, push.last), 0), 0));
    const float scale = exp2(-float(clamp(level, 0, push.last)));
    const PyramidLevel where = PyramidLevel(rectangle.xy, rectangle.zw, scale * vec2(push.size), push.inverseImage);
    const vec2 at = scale * place;
    return FETCH == 0 || level <= 0 ? levelAt(chain, where, at) : cubicAt(chain, where, at);
}

vec4 chainAt(sampler2D chain, float level, vec2 place) {
    const int first = int(floor(level));
    const float t = level - float(first), s = 1.0 - t;
    if (FETCH < 2) return s * chainLevel(chain, first, place) + t * chainLevel(chain, first + 1, place);
    return (s * s * s * chainLevel(chain, first - 1, place) + t * t * t * chainLevel(chain, first + 2, place)) / 6.0 +
           (2.0 / 3.0 - 0.5 * t * t * (2.0 - t)) * chainLevel(chain, first, place) +
           (2.0 / 3.0 - 0.5 * s * s * (2.0 - s)) * chainLevel(chain, first + 1, place);
}

float levelOf(float spread) { return clamp(log2(max(spread, 1.0e-9) / push.levelScale), 0.0, float(push.last)); }

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, push.size))) return;
    const vec2 place = vec2(pixel) + 0.5;
    float level = levelOf(texelFetch(scattered, pixel, 0).a);
    if (MASKED) {
        for (int i = 0; i < push.depthLookups; ++i) level = levelOf(sqrt(max(chainAt(depth, level, place).r, 0.0)));
    }
    vec3 light = texelFetch(sharp, pixel, 0).rgb + chainAt(scattered, level, place).rgb;
    if (MASKED && SEPARATE) {
        const float near = sqrt(max(chainAt(separated, push.separationLevel * float(push.last), place).a, 0.0));
        light += chainAt(separated, levelOf(near), place).rgb;
    }
    imageStore(result, pixel, vec4(light, 1.0));
}
