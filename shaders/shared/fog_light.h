// Light of level fog without clouds: tables by height and direction (light/fog_light/fog_light.h), and where values lie
// in them.
#ifndef LUMULUS_SHARED_FOG_LIGHT_H
#define LUMULUS_SHARED_FOG_LIGHT_H

#include "shared/prelude.h"

#ifdef __cplusplus
namespace lumulus::shared {
using glm::acos;
using glm::asin;
}  // namespace lumulus::shared
#endif

SHARED_BEGIN

/// Rows of directions that are looked at, from the horizon to the zenith; as many from the horizon to the nadir follow.
const int FOG_ROWS = 96;
/// Columns of azimuths from the sun's to the one opposite to it, denser at the sun.
const int FOG_COLUMNS = 33;
/// Heights of a table that tells between which levels a height lies.
const int FOG_HEIGHTS = 2048;
/// Angle above the horizon below which rows are evenly spaced [radians]; beyond it in proportion to the angle.
const float FOG_FINEST_ANGLE = 1.0e-3F;
/// asinh(π/2 / FOG_FINEST_ANGLE)
const float FOG_ROW_SCALE = 8.05248527F;

/// The row of a direction whose sine of elevation is `up`, 0 to FOG_ROWS − 1 on either side of the horizon.
SHARED_FN float fogRow(float up) {
    const float x = asin(min(abs(up), 1.0F)) / FOG_FINEST_ANGLE;
    return log(x + sqrt(x * x + 1.0F)) / FOG_ROW_SCALE * float(FOG_ROWS - 1);
}

/// The column of a direction, by the cosine of its azimuth from the sun's.
SHARED_FN float fogColumn(float cosine) {
    return sqrt(acos(clamp(cosine, -1.0F, 1.0F)) * 0.318309886F) * float(FOG_COLUMNS - 1);
}

/// Henyey–Greenstein's phase function [1/sr].
SHARED_FN float fogPhase(float g, float cosine) {
    const float away = max(1.0F + g * g - 2.0F * g * cosine, 1.0e-6F);
    return 0.0795774715F * (1.0F - g * g) / (away * sqrt(away));
}

SHARED_END

#endif
