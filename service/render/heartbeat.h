#pragma once

#include <atomic>

#include "service/values/requests.h"

namespace lumulus::service {

/// Tells whether a thread that works in steps still moves. One thread steps and rests; any thread asks.
class Heartbeat {
  public:
    /// A step of work begins.
    void step() { last_ = Clock::now().time_since_epoch().count(); }
    /// There is nothing to do.
    void rest() { last_ = resting; }
    /// Seconds since the last step began; 0 at rest.
    double silentSeconds(Clock::time_point now) const;

  private:
    static constexpr Clock::rep resting = -1;

    std::atomic<Clock::rep> last_{resting};
};

}  // namespace lumulus::service
