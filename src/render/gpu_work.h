#pragma once

#include <functional>

#include "frame/pass_times.h"
#include "gpu/commands.h"

namespace lumulus {

/// Where passes are recorded and run, one submission after the other, with the times that they took.
struct GpuWork {
    explicit GpuWork(gpu::Context& gpuContext) : context(gpuContext), commands(gpuContext) {}

    gpu::Context& context;
    gpu::Commands commands;
    std::vector<gpu::PassTime> times;  ///< of all passes since they were last cleared, by name

    /// Records by `record`, runs, waits and adds the times.
    void run(const std::function<void(gpu::Commands&)>& record) {
        commands.begin();
        record(commands);
        commands.submit();
        commands.wait();
        frame::addTimes(times, commands.times());
    }
};

}  // namespace lumulus
