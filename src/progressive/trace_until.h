#pragma once

#include <functional>
#include <optional>

#include "base/progress.h"
#include "render/renderer.h"

namespace lumulus::progressive {

/// When to stop tracing: the first goal that is met.
struct Goal {
    std::optional<double> seconds;      ///< all work, with drawing and with the caller's work after it
    std::optional<double> targetError;  ///< relMSE of the photons' noise
    double afterDrawing = 0.0;          ///< seconds that the caller will need after draw()
};

enum class Stop { photons, seconds, targetError };

/// Name of a reason to stop: "photons" (the scene needs no more), "seconds", "target-error".
const char* nameOf(Stop stop);

struct Reached {
    Stop stop = Stop::photons;
    int generations = 0;
    std::optional<double> noise;  ///< relMSE; absent: no time for an estimate
    double previewSeconds = 0.0;  ///< spent on estimating the noise
};

/// Traces at least one generation, and more until the goal is met, with a Renderer made for progressive rendering.
/// `elapsed` returns the seconds since the work began. The noise is estimated at growing intervals and when it may have
/// reached the target. Errors: those of Renderer; Error if interrupted.
Reached traceUntil(Renderer& renderer, const Goal& goal, const std::function<double()>& elapsed, const Report& report);

}  // namespace lumulus::progressive
