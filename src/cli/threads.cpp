#include "cli/threads.h"

#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>
#include <system_error>
#include <thread>

#include "base/error.h"
#include "base/threads.h"

namespace lumulus::cli {
namespace {

constexpr const char* limits = "ulimit -u, pids.max of the cgroup";

/// Threads beside the main one, if `cores` are used. lavapipe has one a core for compute shaders, as many for the
/// rasteriser (neither on a single core), a queue and a cache of shaders.
int needed(ThreadUse use, int cores) {
    const int host = cores - 1, device = host + (cores > 1 ? 2 * cores : 0) + 2;
    constexpr int serving = 6;  // network, rendering, loading, shutting down
    return use == ThreadUse::host ? host : use == ThreadUse::device ? device : device + cores + serving;
}

void requireThreads(ThreadUse use, int cores) {
    const int wanted = needed(use, cores), found = startableThreads(wanted);
    if (found >= wanted) return;
    int fewer = cores - 1;
    while (fewer > 0 && needed(use, fewer) > found) --fewer;
    throw Error(fmt::format("the system lets this process start {} of the {} threads that it needs", found, wanted),
                limits, fewer > 0 ? fmt::format("raise the limit, or give --threads {}", fewer) : "raise the limit");
}

}  // namespace

void limitThreads(std::optional<int> threads, ThreadUse use) {
    const auto cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    requireThreads(use, threads.value_or(cores));
    if (!threads) return;
    // it is never destroyed: oneTBB would start the threads that it held back
    static const auto* const limit =
        new tbb::global_control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(*threads));
    static_cast<void>(limit);
    // lavapipe's own number on a single core is 0: shaders run on the thread that submits them
    const std::string ofDriver = std::to_string(*threads > 1 ? *threads : 0);
    ::setenv("LP_NUM_THREADS", ofDriver.c_str(), 1);
}

bool isThreadRefused(const std::exception& failure) {
    const auto* system = dynamic_cast<const std::system_error*>(&failure);
    if (system != nullptr && system->code() == std::errc::resource_unavailable_try_again) return true;
    return std::string_view(failure.what()).find("pthread_create") !=
           std::string_view::npos;  // oneTBB has no type for it
}

std::string unforeseen(const std::exception& failure) {
    if (!isThreadRefused(failure)) return failure.what() + std::string(": this should not happen, please report it");
    return Error("the system lets this process start no more threads", limits, "raise the limit, or give --threads 1")
        .what();
}

}  // namespace lumulus::cli
