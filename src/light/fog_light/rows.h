#pragma once

#include "light/fog_light/transport.h"

namespace lumulus::fog_light {

/// Cosines to the vertical of the rows of shared/fog_light.h.
Vector rowCosines();
/// Azimuths of its columns [radians].
Vector columnAzimuths();

/// Radiance of one mode that is seen from each level along each row, of light that a stack scatters out of these
/// moments and sends by itself, over the share of light that the fog along the row lets not pass: [level][2 ·
/// FOG_ROWS]. That quotient changes little with height and direction, where the light itself grows with the way through
/// the fog.
Vector seenAlongRows(const Stack& stack, int mode, const Vector& moments);

/// The same of the beam's light that a source scatters once: `scattered` of each interval, over its extinction; over
/// irradiance and phase function.
Vector onceAlongRows(const Stack& stack, const Vector& scattered, double beamCosine);

}  // namespace lumulus::fog_light
