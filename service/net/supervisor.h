#pragma once

#include <string>

#include "service/values/requests.h"

namespace lumulus::service {

/// Tells systemd how the service is (sd_notify(3)); nothing where systemd did not start it.
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
    Clock::duration period_ = Clock::duration::zero();  // of the watchdog; zero: there is none
    Clock::time_point told_;
};

}  // namespace lumulus::service
