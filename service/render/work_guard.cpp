#include "service/render/work_guard.h"

#include <utility>

#include "base/interrupt.h"
#include "service/render/durations.h"

namespace lumulus::service {

WorkGuard::WorkGuard(double seconds, std::function<void()> abandoned, std::function<void(std::string_view)> begins)
    : abandoned_(std::move(abandoned)), begins_(std::move(begins)), deadline_(Clock::now() + inSeconds(seconds)) {}

void WorkGuard::serve(std::function<double()> step) {
    abandoned_ = {};
    begins_ = {};
    deadline_ = Clock::time_point::max();
    step_ = std::move(step);
}

void WorkGuard::check() {
    stopIfInterrupted();
    if (abandoned_) abandoned_();
    if (step_ && std::this_thread::get_id() == worker_) {
        const auto start = Clock::now();
        const auto pausedBefore = paused_;
        stepSeconds_ = step_();
        const auto pause = Clock::now() - start;
        paused_ = pausedBefore + pause;  // whatever paused a picture of this scene within
        if (deadline_ != Clock::time_point::max()) deadline_ += pause;
    }
    if (cancelled_ != nullptr && cancelled_->load()) throw Cancelled{};
    if (Clock::now() > deadline_) throw TooSlow(ofPicture_);
}

void WorkGuard::begin(std::string_view step) {
    check();
    if (begins_) begins_(step);
}

double WorkGuard::workedSince(Clock::time_point start, Clock::duration pausedBefore) const {
    return milliseconds(Clock::now() - start - (paused_ - pausedBefore));
}

WorkGuard::Work::Work(WorkGuard& guard, const std::atomic<bool>* cancelled, double seconds, bool ofPicture)
    : guard_(guard),
      cancelledBefore_(std::exchange(guard.cancelled_, cancelled)),
      deadlineBefore_(std::exchange(guard.deadline_, Clock::now() + inSeconds(seconds))),
      ofPictureBefore_(std::exchange(guard.ofPicture_, ofPicture)) {
    guard_.worker_ = std::this_thread::get_id();
}

WorkGuard::Work::~Work() {
    guard_.cancelled_ = cancelledBefore_;
    guard_.deadline_ = deadlineBefore_;
    guard_.ofPicture_ = ofPictureBefore_;
}

}  // namespace lumulus::service
