#pragma once

#include <vector>

#include "medium/phase_function.h"

namespace lumulus::phase {

/// 1 − cos θ at the entries (shared/phase_table.h, inverseCdfNode) of the inverse CDF of p restricted to θ ≥ thetaCut
/// [radians]: inverseCdfCells + 1 values that fall from 2 at u = 0 to 1 − cos thetaCut at u = 1.
std::vector<float> makeInverseCdf(const PhaseFunction& phase, double thetaCut);

}  // namespace lumulus::phase
