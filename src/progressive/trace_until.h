#pragma once

#include <functional>
#include <optional>

#include "base/progress.h"
#include "render/renderer.h"

namespace lumulus::progressive {

/// When to stop: whichever is met first.
struct Goal {
    std::optional<double> seconds;      ///< of all work, with drawing and with what follows
    std::optional<double> targetError;  ///< relMSE of the photons' noise
    double afterDrawing = 0.0;          ///< seconds that the caller will need after draw()
};

enum class Stop { photons, seconds, targetError };

/// "photons": the scene needs none, or no more; "seconds"; "target-error".
const char* nameOf(Stop stop);

struct Reached {
    Stop stop = Stop::photons;
    int generations = 0;
    std::optional<double> noise;  ///< relMSE; absent: the time did not suffice to tell
    double previewSeconds = 0.0;  ///< spent on finding out
};

/// Traces generations with a Renderer made for progressive rendering until the goal is met; at least one. `elapsed`
/// tells the seconds since the work began. The noise is looked at again when it may have reached the target, and at
/// growing distances. Errors: those of Renderer; Error where interrupted.
Reached traceUntil(Renderer& renderer, const Goal& goal, const std::function<double()>& elapsed, const Report& report);

}  // namespace lumulus::progressive
