#pragma once

#include <memory>
#include <variant>

#include "service/render/scheduler.h"
#include "service/values/results.h"

namespace lumulus::service {

class SceneSlot;

/// A drawn picture on its way to the client who asked for it.
struct FrameTask {
    Job job;
    std::variant<FrameResult, CompositeResult> result;
    std::weak_ptr<SceneSlot> slot;  ///< that drew it, and learns what encoding costs
    MemoryBudget::Share memory;     ///< that the pictures hold
};

/// What encoding a frame took.
struct EncodingReport {
    double milliseconds = 0.0;
    double totalMilliseconds = 0.0;  ///< from the request's arrival until the frame was encoded
    std::uint64_t pixels = 0;
};

}  // namespace lumulus::service
