#include "service/net/write_rate.h"

namespace lumulus::service {

bool WriteRate::tooSlow(Clock::time_point now) {
    if (!since_) return false;
    const double seconds = std::chrono::duration<double>(now - *since_).count();
    if (seconds < seconds_) return false;
    if (static_cast<double>(bytes_) < seconds * bytesPerSecond_) return true;
    since_ = now;
    bytes_ = 0;
    return false;
}

}  // namespace lumulus::service
