#pragma once

#include <span>
#include <vector>

#include "base/progress.h"
#include "bench/measure.h"
#include "bench/record.h"
#include "scene/scene.h"

namespace lumulus::bench {

/// Renders pictures with the reference tracer at each budget (seconds without warm-up, in rising order) and seed, with
/// its local majorant, which is the faster one. A seed is one run whose picture is measured when a budget is spent,
/// after one whole pass at least, so the pictures of a seed share samples. The time without warm-up contains passes and
/// picture, but not loading, majorants and measuring. `progress` advances by one for each seed and budget. Errors:
/// those of the reference tracer; Error if interrupted.
std::vector<Run> pathTracerRuns(const scene::Scene& scene, const Truth& truth, std::span<const double> budgets,
                                std::span<const std::uint64_t> seeds, Progress& progress);

}  // namespace lumulus::bench
