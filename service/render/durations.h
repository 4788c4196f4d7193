#pragma once

#include "service/values/requests.h"

namespace lumulus::service {

inline double milliseconds(Clock::duration duration) {
    return std::chrono::duration<double, std::milli>(duration).count();
}

inline double millisecondsSince(Clock::time_point start) {
    return milliseconds(Clock::now() - start);
}

inline Clock::duration inSeconds(double seconds) {
    return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

}  // namespace lumulus::service
