#include "service/render/heartbeat.h"

namespace lumulus::service {

double Heartbeat::silentSeconds(Clock::time_point now) const {
    const Clock::rep last = last_.load();
    if (last == resting) return 0.0;
    return std::chrono::duration<double>(now.time_since_epoch() - Clock::duration(last)).count();
}

}  // namespace lumulus::service
