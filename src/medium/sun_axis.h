#pragma once

#include <vector>

#include "medium/phase_function.h"

/// What is scattered by light that travels in rings about the sun's axis (shared/sun_axis.h).
namespace lumulus::phase {

/// Whether a phase function has a backward peak so sharp that the bands of a collector cannot hold the light that goes
/// to and fro along the sun's axis. Tables have none.
bool hasBackwardPeak(const PhaseFunction& phase);

/// The mean of p [1/sr] over the directions of each ring without its Legendre terms below `bands`, by the angle between
/// the ring's middle and the direction after scattering: AXIS_RINGS rows of singleScatterAngleCount entries, looked up
/// with tableCell(angleToAxis(angle, angleScale), singleScatterAngleCount). `mirrored` is p(π − θ), whose peak is
/// forward.
std::vector<float> makeAxisTable(const PhaseFunction& mirrored, double angleScale, int bands);

}  // namespace lumulus::phase
