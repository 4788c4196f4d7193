#pragma once

#include <cstdint>

#include "service/values/requests.h"

namespace lumulus::service {

/// When the frames of a stream are due, and which number each has. Not for several threads.
class Pace {
  public:
    struct Frame {
        std::uint64_t number = 0;  ///< frames before it; with a rhythm, moments before it, those left out too
        Clock::time_point since;   ///< from when its milliseconds count: its moment, or without a rhythm now
    };

    Pace(const StartStream& wishes, Clock::time_point now);
    /// New wishes. Frames come no sooner than before for the same rate. The same rhythm goes on; another one begins
    /// anew, with the numbers that follow.
    void wish(const StartStream& wishes, Clock::time_point now);

    /// The moment of the next frame, as far as none was left out.
    Clock::time_point due() const { return due_; }
    /// When the next frame should begin: due(), or of a rhythm that is late by more than half of what lies between two
    /// frames, the moment that is still to come.
    Clock::time_point next(Clock::time_point now) const;
    /// Takes the frame that is due `now`. Moments of a rhythm that have passed are left out.
    Frame take(Clock::time_point now);

  private:
    Clock::rep leftOut(Clock::time_point now) const;

    bool rhythm_ = false;
    double phase_ = 0.0;
    Clock::duration period_{};
    Clock::time_point due_;
    std::uint64_t number_ = 0;  // of the frame at due_
};

}  // namespace lumulus::service
