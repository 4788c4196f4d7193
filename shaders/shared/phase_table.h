// Axes of the tables that stand for a phase function on the GPU (src/phase/scattering_tables.h fills them). A lookup is
//   TableCell cell = …Cell(…);  value = mix(table[cell.base], table[cell.base + 1], cell.fraction);
// which stays with the caller because GLSL cannot pass a storage buffer to a function.
#ifndef LUMULUS_SHARED_PHASE_TABLE_H
#define LUMULUS_SHARED_PHASE_TABLE_H

#include "shared/phase.h"
#include "shared/prelude.h"

SHARED_BEGIN

const int inverseCdfCells = 1024;         // the table has one entry more
const int phaseTableSize = 2048;          // entries along the angle
const int singleScatterAngleCount = 512;  // entries along the angle
const int singleScatterTauCount = 128;    // entries along the optical depth, which runs fastest, but for the channel

/// Where a value lies between entries base and base + 1.
struct TableCell {
    int base;
    float fraction;  ///< in [0,1]
};

/// The cell of axis coordinate x, clamped to [0,1], in an axis of `size` entries.
SHARED_FN TableCell tableCell(float x, int size) {
    float position = clamp(x, 0.0F, 1.0F) * float(size - 1);
    int base = min(int(position), size - 2);
    return TableCell(base, position - float(base));
}

/// The angle axis in [0,1], fine near both poles: ½ + ½ ln((s+q₋)/(s+q₊)) / ln(1+2/s), q₋ = 2 sin θ/2 and q₊ = 2 cos
/// θ/2 the chords from the two poles; `scale` s is about the width of the lobe [radians].
SHARED_FN float angleToAxis(ScatterAngle angle, float scale) {
    float fromFront = sqrt(2.0F * angle.oneMinusCos);
    float fromBack = sqrt(2.0F * angle.onePlusCos);
    return 0.5F + 0.5F * log((scale + fromFront) / (scale + fromBack)) / log(1.0F + 2.0F / scale);
}

/// Axis of optical depth in [0,1]: ln(1+τ) / ln(1+τ_max); beyond τ_max the tables are constant.
SHARED_FN float tauToAxis(float tau, float tauMaximum) {
    return min(log(1.0F + tau) / log(1.0F + tauMaximum), 1.0F);
}

/// u of entry i of the inverse CDF: quadratically dense near 0 and 1.
SHARED_FN float inverseCdfNode(int i) {
    float s = float(i) / float(inverseCdfCells);
    return s < 0.5F ? 2.0F * s * s : 1.0F - 2.0F * (1.0F - s) * (1.0F - s);
}

/// The cell of u in [0,1); interpolation is linear in u, so that a cell has exactly its share of the probability.
SHARED_FN TableCell inverseCdfCell(float u) {
    float s = u < 0.5F ? sqrt(0.5F * u) : 1.0F - sqrt(0.5F * (1.0F - u));
    int base = clamp(int(s * float(inverseCdfCells)), 0, inverseCdfCells - 1);
    float begin = inverseCdfNode(base);
    float end = inverseCdfNode(base + 1);
    return TableCell(base, clamp((u - begin) / (end - begin), 0.0F, 1.0F));
}

/// Index of (angle, optical depth) of the red entry of a single-scattering table; green and blue follow, and the next
/// optical depth is 3 further, the next angle 3·singleScatterTauCount.
SHARED_FN int singleScatterIndex(int angle, int tau) {
    return 3 * (angle * singleScatterTauCount + tau);
}

SHARED_END

#endif
