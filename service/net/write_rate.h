#pragma once

#include <cstddef>
#include <optional>

#include "service/values/requests.h"

namespace lumulus::service {

/// Whether a client takes what it is sent fast enough. Time counts while something waits for it; in each period of so
/// many seconds it has to take at least so many bytes a second.
class WriteRate {
  public:
    WriteRate(double seconds, double bytesPerSecond) : seconds_(seconds), bytesPerSecond_(bytesPerSecond) {}

    /// Something waits to be written from now on.
    void begin(Clock::time_point now) {
        if (!since_) since_ = now;
    }
    void wrote(std::size_t bytes) { bytes_ += bytes; }
    /// Nothing waits any more.
    void end() {
        since_.reset();
        bytes_ = 0;
    }
    /// Whether a period is over in which too little was taken. Otherwise the next one begins when it is.
    bool tooSlow(Clock::time_point now);

  private:
    double seconds_, bytesPerSecond_;
    std::optional<Clock::time_point> since_;
    std::size_t bytes_ = 0;  // since then
};

}  // namespace lumulus::service
