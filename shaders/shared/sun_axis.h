// Rings about the sun's axis. Where a phase function has a backward peak, the sun's light goes to and fro along its
// axis, in lobes that are too narrow for the bands of a collector. There photons are counted in rings about both ends of
// the axis instead: sharp in angle, and the same all round.
#ifndef LUMULUS_SHARED_SUN_AXIS_H
#define LUMULUS_SHARED_SUN_AXIS_H

#include "shared/phase.h"
#include "shared/prelude.h"

SHARED_BEGIN

/// About each end of the axis. Edges grow by the root of 2 from one to the next.
const int AXIS_RINGS = 14;
/// Chords (2 sin θ/2) from the end of the axis within which all light belongs to the rings, and beyond which none does.
const float AXIS_WHOLE = 0.35F;
const float AXIS_REACH = 0.7F;
/// Sums of a collector: front and back rings, RGB.
const uint AXIS_COUNTS = 6U * 14U;

/// Inner edge of a ring, as a chord; of the number behind the last one, the reach.
SHARED_FN float axisRingEdge(int ring) {
    return ring <= 0 ? 0.0F : AXIS_REACH * pow(2.0F, 0.5F * float(ring - AXIS_RINGS));
}

/// The ring in which a chord below the reach lies.
SHARED_FN int axisRing(float chord) {
    float place = float(AXIS_RINGS) + 2.8853901F * log(max(chord, 1.0e-6F) / AXIS_REACH);
    return min(max(int(floor(place)), 0), AXIS_RINGS - 1);
}

/// Part of the light at a chord from the end of the axis that is counted in rings; bands take the rest.
SHARED_FN float axisShare(float chord) {
    return min(max((AXIS_REACH - chord) / (AXIS_REACH - AXIS_WHOLE), 0.0F), 1.0F);
}

SHARED_END

#endif
