#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "service/net/encoder_pool.h"
#include "service/values/requests.h"

namespace lumulus::service {

/// Tells systemd how the service is (sd_notify(3)); nothing where systemd did not start it. Nobody waits for systemd:
/// it is told on a thread of its own, and not told what it has no room for.
class Supervisor {
  public:
    Supervisor();

    /// The service listens. `status` is what `systemctl status` shows.
    void ready(const std::string& status);
    void status(const std::string& text);
    void stopping();
    /// The service is alive. Call it often: systemd is told as often as its watchdog asks for.
    void alive(Clock::time_point now);

  private:
    void tell(const std::string& state);

    Clock::duration period_ = Clock::duration::zero();  // of the watchdog; zero: there is none
    Clock::time_point told_;
    std::atomic<int> waiting_{0};          // of what is to be told
    std::unique_ptr<EncoderPool> thread_;  // null where there is no systemd; last: ends first
};

}  // namespace lumulus::service
