#include "service/render/pace.h"

#include <algorithm>

namespace lumulus::service {

namespace {

Clock::duration milliseconds(double count) {
    return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double, std::milli>(count));
}

Clock::duration periodOf(const StartStream& wishes) {
    return milliseconds(wishes.rhythm ? wishes.rhythm->every : 1e3 / wishes.maxRate);
}

}  // namespace

Pace::Pace(const StartStream& wishes, Clock::time_point now)
    : rhythm_(wishes.rhythm.has_value()),
      phase_(rhythm_ ? wishes.rhythm->phase : 0.0),
      period_(periodOf(wishes)),
      due_(now + milliseconds(phase_)) {}

void Pace::wish(const StartStream& wishes, Clock::time_point now) {
    const bool rhythm = wishes.rhythm.has_value();
    const bool goesOn =
        rhythm == rhythm_ && (!rhythm || (periodOf(wishes) == period_ && wishes.rhythm->phase == phase_));
    if (!goesOn) {
        const std::uint64_t number = number_;
        *this = Pace(wishes, now);
        number_ = number;
    }
    period_ = periodOf(wishes);
}

/// Moments of a rhythm before the one that a frame that begins now is for.
Clock::rep Pace::leftOut(Clock::time_point now) const {
    if (!rhythm_ || now <= due_) return 0;
    const Clock::duration late = now - due_;
    return late / period_ + (2 * (late % period_) > period_ ? 1 : 0);
}

Clock::time_point Pace::next(Clock::time_point now) const {
    return due_ + leftOut(now) * period_;
}

Pace::Frame Pace::take(Clock::time_point now) {
    const Clock::rep left = leftOut(now);
    const Frame frame{number_ + static_cast<std::uint64_t>(left), rhythm_ ? due_ + left * period_ : now};
    number_ = frame.number + 1;
    // without a rhythm, a frame that comes late does not make those after it come in a bunch
    due_ = rhythm_ ? frame.since + period_ : std::max(due_ + period_, now);
    return frame;
}

}  // namespace lumulus::service
