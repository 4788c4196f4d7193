#pragma once

#include <span>
#include <vector>

#include "base/progress.h"
#include "bench/measure.h"
#include "bench/record.h"
#include "scene/scene.h"

namespace lumulus::bench {

/// Pictures of the reference tracer with its local majorant, the faster of the two, at each budget (seconds without
/// warm-up, in rising order) and seed. A seed is one run, looked at whenever a budget is spent, after whole passes and
/// at least one: its pictures share samples. The time without warm-up is that of the passes and of the picture;
/// loading, majorants and measuring are outside. `progress` advances by one a seed and budget. Errors: those of the
/// reference tracer; Error where interrupted.
std::vector<Run> pathTracerRuns(const scene::Scene& scene, const Truth& truth, std::span<const double> budgets,
                                std::span<const std::uint64_t> seeds, Progress& progress);

}  // namespace lumulus::bench
