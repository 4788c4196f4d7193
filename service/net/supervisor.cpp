#include "service/net/supervisor.h"

#include <systemd/sd-daemon.h>

namespace lumulus::service {

Supervisor::Supervisor() {
    std::uint64_t microseconds = 0;
    if (::sd_watchdog_enabled(0, &microseconds) > 0) period_ = std::chrono::microseconds(microseconds);
}

void Supervisor::ready(const std::string& status) {
    ::sd_notify(0, ("READY=1\nSTATUS=" + status).c_str());
}

void Supervisor::status(const std::string& text) {
    ::sd_notify(0, ("STATUS=" + text).c_str());
}

void Supervisor::stopping() {
    ::sd_notify(0, "STOPPING=1\nSTATUS=shutting down");
}

void Supervisor::alive(Clock::time_point now) {
    if (period_ == Clock::duration::zero() || now - told_ < period_ / 4) return;
    told_ = now;
    ::sd_notify(0, "WATCHDOG=1");
}

}  // namespace lumulus::service
