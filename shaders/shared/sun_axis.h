// Rings about the sun's axis. Where a phase function has a backward peak, the sun's light goes to and fro along its
// axis, in lobes that are too narrow for the bands of a collector. There the sun's photons are counted in rings about
// both ends of the axis too: sharp in angle, and the same all round. Bands above those of the collectors come from
// them.
#ifndef LUMULUS_SHARED_SUN_AXIS_H
#define LUMULUS_SHARED_SUN_AXIS_H

#include "shared/phase.h"
#include "shared/prelude.h"

SHARED_BEGIN

/// About each end of the axis, as far as a right angle. Edges grow by the third root of 2 from one to the next.
const int AXIS_RINGS = 24;
/// Sums of a collector: front and back rings, RGB.
const uint AXIS_COUNTS = 6U * 24U;

/// Inner edge of a ring, as a chord (2 sin θ/2) from the end of the axis; of the number behind the last one, √2.
SHARED_FN float axisRingEdge(int ring) {
    return ring <= 0 ? 0.0F : 1.41421356F * pow(2.0F, float(ring - AXIS_RINGS) / 3.0F);
}

/// The ring in which a chord lies.
SHARED_FN int axisRing(float chord) {
    float place = float(AXIS_RINGS) + 4.3280851F * log(max(chord, 1.0e-6F) / 1.41421356F);
    return min(max(int(floor(place)), 0), AXIS_RINGS - 1);
}

SHARED_END

#endif
