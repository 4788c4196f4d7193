#pragma once

/// The inverses, in double, of the axes in shared/phase_table.h.
namespace lumulus::phase {

/// The angle θ [radians] at x in [0,1] of the angle axis.
double axisToAngle(double x, double scale);

/// The optical depth at x in [0,1] of the τ axis.
double axisToTau(double x, double tauMaximum);

}  // namespace lumulus::phase
