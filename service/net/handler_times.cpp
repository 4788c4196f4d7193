#include "service/net/handler_times.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "service/telemetry/metrics.h"

namespace lumulus::service {

namespace {

using std::chrono::microseconds;
using std::chrono::nanoseconds;

// Asio's macros have no argument that could bring it
thread_local HandlerTimes* timesOfThread = nullptr;

nanoseconds waitedForCore() {
    return timesOfThread == nullptr ? nanoseconds(0) : timesOfThread->waitedForCore();
}

}  // namespace

HandlerTimes::HandlerTimes(Metrics& metrics)
    : metrics_(metrics), accounts_(::open("/proc/thread-self/schedstat", O_RDONLY | O_CLOEXEC)) {
    timesOfThread = this;
}

HandlerTimes::~HandlerTimes() {
    timesOfThread = nullptr;
    if (accounts_ >= 0) ::close(accounts_);
}

nanoseconds HandlerTimes::waitedForCore() const {
    std::array<char, 96> text;  // "worked waited slices", the times in nanoseconds
    const ssize_t size = accounts_ >= 0 ? ::pread(accounts_, text.data(), text.size(), 0) : 0;
    const char* const end = text.data() + std::max<ssize_t>(0, size);
    const char* const space = std::find(static_cast<const char*>(text.data()), end, ' ');
    nanoseconds::rep waited = 0;
    if (space != end) std::from_chars(space + 1, end, waited);
    return nanoseconds(waited);
}

void HandlerTimes::took(microseconds time) {
    if (time > bound) metrics_.add(Metrics::slowHandlers);
    if (time <= longest_) return;
    longest_ = time;
    metrics_.set(Metrics::longestHandler, time.count());
}

HandlerTimer::HandlerTimer() : waitedBefore_(waitedForCore()), begun_(std::chrono::steady_clock::now()) {}

/// A thread that had to wait for a core did not take that time itself.
HandlerTimer::~HandlerTimer() {
    if (timesOfThread == nullptr) return;
    nanoseconds time = std::chrono::steady_clock::now() - begun_;
    constexpr std::chrono::milliseconds noticed{1};
    if (time > noticed) time -= waitedForCore() - waitedBefore_;
    timesOfThread->took(std::chrono::duration_cast<microseconds>(std::max(time, nanoseconds(0))));
}

}  // namespace lumulus::service
