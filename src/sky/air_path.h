#pragma once

#include <vector>

#include "sky/air.h"
#include "sky/multiple_scattering.h"

namespace lumulus::sky {

/// A step of a path through the air: what of it does not depend on where the sun stands.
struct AirStep {
    double distance = 0.0;  ///< from the path's eye [m]
    double height = 0.0;    ///< m
    double up = 1.0;        ///< cosine of the ray to the upward direction there
    AirDensity density;
    Spectrum weight{0.0};  ///< metres of a source there that the eye sees
};

/// A path through the air, seen from its eye, which may lie above the air.
struct AirPath {
    std::vector<AirStep> steps;
    Spectrum transmittance{1.0};
};

/// The first `length` metres of a ray, as far as they lie in the air.
AirPath makeAirPath(const Air& air, double height, double up, double length, int steps);

/// The point of a ray `distance` metres on, where its height and direction are known.
AirPoint pointOf(const AirPoint& from, const AirStep& step);

}  // namespace lumulus::sky
