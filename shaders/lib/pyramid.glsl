// Levels of a pyramid that lie side by side in one image. Places are in pixels of a level, from its upper left corner.
// Beyond the border the level mirrors, so that a constant picture stays constant.
#ifndef LUMULUS_LIB_PYRAMID
#define LUMULUS_LIB_PYRAMID

#include "shared/fog.h"

/// Where a level lies in the image, in texels, where the picture ends in it, and one over the image's size.
struct PyramidLevel {
    ivec2 offset;
    ivec2 size;
    vec2 extent;
    vec2 inverseImage;
};

PyramidLevel finerLevel(LevelPush push) {
    return PyramidLevel(push.finerOffset, push.finerSize, push.finerExtent, push.inverseImage);
}

PyramidLevel coarserLevel(LevelPush push) {
    return PyramidLevel(push.coarserOffset, push.coarserSize, 0.5 * push.finerExtent, push.inverseImage);
}

/// A place within the level: what a mirror at the picture's borders shows.
vec2 mirrored(vec2 place, PyramidLevel level) {
    const vec2 once = abs(place);
    return clamp(min(once, 2.0 * level.extent - once), vec2(0.5), vec2(level.size) - 0.5);
}

/// Linear between pixels.
vec4 levelAt(sampler2D pyramid, PyramidLevel level, vec2 place) {
    return textureLod(pyramid, (vec2(level.offset) + mirrored(place, level)) * level.inverseImage, 0.0);
}

/// Cubic B-spline over 4×4 pixels in four taps between them (Sigg and Hadwiger 2005).
vec4 cubicAt(sampler2D pyramid, PyramidLevel level, vec2 place) {
    const vec2 base = floor(place - 0.5) + 0.5, t = place - base, s = 1.0 - t;
    const vec2 outer = s * s * s / 6.0, inner = 2.0 / 3.0 - 0.5 * t * t * (2.0 - t);  // weights of the first two
    const vec2 low = outer + inner, high = 1.0 - low;
    const vec2 near = base - 1.0 + inner / low, far = base + 1.0 + t * t * t / (6.0 * high);
    return low.y * (low.x * levelAt(pyramid, level, near) + high.x * levelAt(pyramid, level, vec2(far.x, near.y))) +
           high.y * (low.x * levelAt(pyramid, level, vec2(near.x, far.y)) + high.x * levelAt(pyramid, level, far));
}

/// Places of the taps of the filter between levels, around the middle of four finer pixels, in finer pixels: each stands
/// for two pixels, weighed by where the tap falls between them. 2: box; 4: {.13, .37, .37, .13} (Burt 1981); 6: binomial.
const float TAP_PLACES[6] = float[6](0.0, -0.76, 0.76, -1.6666667, 0.0, 1.6666667);
const float TAP_WEIGHTS[6] = float[6](1.0, 0.5, 0.5, 0.1875, 0.625, 0.1875);

/// The filter between levels at a pixel of the coarser one. `pairs` is half the taps across.
vec4 reduced(sampler2D pyramid, LevelPush push, ivec2 coarse, int pairs) {
    const int first = pairs * (pairs - 1) / 2;
    const vec2 middle = 2.0 * vec2(coarse) + 1.0;
    const PyramidLevel finer = finerLevel(push);
    vec4 sum = vec4(0.0);
    for (int y = first; y < first + pairs; ++y) {
        for (int x = first; x < first + pairs; ++x) {
            const vec2 place = middle + vec2(TAP_PLACES[x], TAP_PLACES[y]);
            sum += TAP_WEIGHTS[x] * TAP_WEIGHTS[y] * levelAt(pyramid, finer, place);
        }
    }
    return sum;
}

#endif
