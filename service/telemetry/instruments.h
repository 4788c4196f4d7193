#pragma once

#include "service/telemetry/event_log.h"
#include "service/telemetry/memory_budget.h"
#include "service/telemetry/metrics.h"

namespace lumulus::service {

/// What every part of the service reports to and draws from. Outlives all of them.
struct Instruments {
    explicit Instruments(std::uint64_t memoryBytes) : memory(memoryBytes, metrics) {}

    Metrics metrics;
    EventLog log{metrics};
    MemoryBudget memory;
};

}  // namespace lumulus::service
