#pragma once

#include <cstdint>
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
    std::optional<double> noise;    ///< relMSE; absent: no time for an estimate
    double previewSeconds = 0.0;    ///< spent on estimating the noise
    std::uint64_t photonsEach = 0;  ///< of a generation, where those of the scene took too long; else 0
    bool unfinished = false;        ///< no generation ended in time: the last one was kept without photons on their way
};

/// Traces at least one generation, and more until the goal is met, with a Renderer made for progressive rendering.
/// `elapsed` returns the seconds since the work began. The noise is estimated at growing intervals and when it may have
/// reached the target. Where `seconds` is given, a generation that does not end in time is dropped. The first one has a
/// share of the time; where it does not end in it, generations of fewer photons take its place, and at last a few
/// photons as far as they come. Errors: those of Renderer; Error if interrupted.
Reached traceUntil(Renderer& renderer, const Goal& goal, const std::function<double()>& elapsed, const Report& report);

/// Traces all generations that the scene wants. Errors: Error where interrupted() is true.
void traceAll(Renderer& renderer, const Report& report);

}  // namespace lumulus::progressive
