// Counter-based random numbers: a pure function of a key, so that a photon's numbers do not depend on the order of
// work.
//
// A key is (x, y, z, w):
//   x  the photon's number, low 32 bits
//   y  the counter of draws of that photon, 0, 1, 2, … (each draw gives four numbers)
//   z  the generation
//   w  rngStream(seed low, seed high, photon's number high): everything that is constant over a dispatch, folded
#ifndef LUMULUS_SHARED_RNG_H
#define LUMULUS_SHARED_RNG_H

#include "shared/prelude.h"

SHARED_BEGIN

/// Four hashed words of four (Jarzynski and Olano 2020, "Hash Functions for GPU Rendering", pcg4d); a bijection.
/// Components must change in their low bits, as counters do: keys a multiple of 2¹⁶ apart fail a χ² test of the first
/// word.
SHARED_FN uvec4 pcg4d(uvec4 v) {
    v = v * 1664525U + 1013904223U;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    v = v ^ (v >> 16U);
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    return v;
}

/// The last word of a key: folds the 64 bits of the seed and the high 32 bits of the photon's number.
SHARED_FN uint rngStream(uint seedLow, uint seedHigh, uint photonHigh) {
    return pcg4d(uvec4(seedLow, seedHigh, photonHigh, 0x9E3779B9U)).w;
}

/// Four independent uniform numbers in [0,1), multiples of 2⁻²⁴ (the high bits, which are the better ones).
SHARED_FN vec4 rngUniform4(uvec4 key) {
    return vec4(pcg4d(key) >> 8U) * (1.0F / 16777216.0F);
}

SHARED_END

#endif
