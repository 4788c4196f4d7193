#pragma once

#include <span>
#include <vector>

#include "base/progress.h"
#include "bench/measure.h"
#include "bench/record.h"
#include "scene/scene.h"

namespace lumulus::bench {

/// Renders a picture for each budget (seconds without warm-up, in rising order) and seed, with as many photons as fill
/// the budget. A small picture is timed first. Each picture has a Renderer of its own. The time without warm-up is that
/// of a picture with a warm device and a prepared cloud: all generations (the first counts as the mean of the others)
/// and a second drawing. `progress` advances by one for each seed and budget. Errors: those of Renderer; Error if
/// interrupted.
std::vector<Run> renderRuns(const scene::Scene& scene, const std::string& device, const Truth& truth,
                            std::span<const double> budgets, std::span<const std::uint64_t> seeds, Progress& progress);

}  // namespace lumulus::bench
