#include "service/net/supervisor.h"

#include <systemd/sd-daemon.h>

#include <cstdlib>

namespace lumulus::service {
namespace {

constexpr int mostWaiting = 8;

}  // namespace

Supervisor::Supervisor() {
    if (std::getenv("NOTIFY_SOCKET") == nullptr) return;
    thread_ = std::make_unique<EncoderPool>(1);
    std::uint64_t microseconds = 0;
    if (::sd_watchdog_enabled(0, &microseconds) > 0) period_ = std::chrono::microseconds(microseconds);
}

void Supervisor::tell(const std::string& state) {
    if (!thread_ || waiting_ >= mostWaiting) return;
    ++waiting_;
    thread_->submit(0, [this, state] {
        ::sd_notify(0, state.c_str());
        --waiting_;
    });
}

void Supervisor::ready(const std::string& status) {
    tell("READY=1\nSTATUS=" + status);
}

void Supervisor::status(const std::string& text) {
    tell("STATUS=" + text);
}

void Supervisor::stopping() {
    tell("STOPPING=1\nSTATUS=shutting down");
}

void Supervisor::alive(Clock::time_point now) {
    if (period_ == Clock::duration::zero() || now - told_ < period_ / 4) return;
    told_ = now;
    tell("WATCHDOG=1");
}

}  // namespace lumulus::service
