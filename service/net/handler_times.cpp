#include "service/net/handler_times.h"

#include <algorithm>

#include "service/telemetry/metrics.h"

namespace lumulus::service {

namespace {

using std::chrono::microseconds;

// Asio's macros have no argument that could bring it
thread_local HandlerTimes* timesOfThread = nullptr;

::rusage usageOfThread() {
    ::rusage used{};
    ::getrusage(RUSAGE_THREAD, &used);
    return used;
}

microseconds processorTime(const ::rusage& used) {
    const auto of = [](const ::timeval& time) {
        return std::chrono::seconds(time.tv_sec) + microseconds(time.tv_usec);
    };
    return of(used.ru_utime) + of(used.ru_stime);
}

}  // namespace

HandlerTimes::HandlerTimes(Metrics& metrics) : metrics_(metrics) {
    timesOfThread = this;
}

HandlerTimes::~HandlerTimes() {
    timesOfThread = nullptr;
}

void HandlerTimes::took(microseconds time) {
    if (time > bound) metrics_.add(Metrics::slowHandlers);
    if (time <= longest_) return;
    longest_ = time;
    metrics_.set(Metrics::longestHandler, time.count());
}

HandlerTimer::HandlerTimer() : begun_(std::chrono::steady_clock::now()), used_(usageOfThread()) {}

/// A thread from which the machine took its core did not take the time itself: then its processor time counts.
HandlerTimer::~HandlerTimer() {
    if (timesOfThread == nullptr) return;
    auto time = std::chrono::duration_cast<microseconds>(std::chrono::steady_clock::now() - begun_);
    constexpr microseconds noticed{1000};
    if (time > noticed) {
        const ::rusage now = usageOfThread();
        if (now.ru_nivcsw != used_.ru_nivcsw) time = std::min(time, processorTime(now) - processorTime(used_));
    }
    timesOfThread->took(time);
}

}  // namespace lumulus::service
