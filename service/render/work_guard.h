#pragma once

#include <atomic>
#include <functional>
#include <stdexcept>
#include <string_view>
#include <thread>

#include "service/values/requests.h"

namespace lumulus::service {

/// Thrown where nobody waits any more for the work at hand.
struct Cancelled {};

/// Thrown where a generation of photons takes longer than the limits allow, so that the scene is of no use under this
/// light, or a picture, which then asks for too much.
class TooSlow : public std::runtime_error {
  public:
    explicit TooSlow(bool ofPicture)
        : std::runtime_error(ofPicture ? "the picture takes longer than the limits of the service allow"
                                       : "the scene takes longer than the limits of the service allow"),
          ofPicture_(ofPicture) {}
    bool ofPicture() const { return ofPicture_; }

  private:
    bool ofPicture_;
};

/// What is asked between the steps of all work on a scene: it ends where nobody waits for it any more or where it takes
/// too long, and others may do work of theirs meanwhile.
class WorkGuard {
  public:
    /// Of a scene that is in use.
    WorkGuard() = default;
    /// Of one that is loaded, for at most so many seconds. `abandoned` is called between the steps; what it throws ends
    /// the load. `begins` is told which step begins. Both may be empty.
    WorkGuard(double seconds, std::function<void()> abandoned, std::function<void(std::string_view)> begins);

    /// The load is over. `step` is called between the steps of all work from now on, and returns the seconds that the
    /// next one should take: on the thread that works, never on those that help it.
    void serve(std::function<double()> step);

    /// On any thread. Errors: Cancelled, TooSlow, what `abandoned` throws, Error where interrupted.
    void check();
    /// A step begins, as "preparing the cloud". Errors: as check().
    void begin(std::string_view step);

    /// Seconds that the next step should take.
    double stepSeconds() const { return stepSeconds_; }
    /// Time so far in which others worked.
    Clock::duration paused() const { return paused_; }
    /// Milliseconds of work since `start`, without what went to others, of which there were `pausedBefore` then.
    double workedSince(Clock::time_point start, Clock::duration pausedBefore) const;

    /// While it lives, work ends where it is cancelled, which may be null, or takes longer than so many seconds.
    class Work {
      public:
        Work(WorkGuard& guard, const std::atomic<bool>* cancelled, double seconds, bool ofPicture);
        Work(const Work&) = delete;
        Work& operator=(const Work&) = delete;
        ~Work();

      private:
        WorkGuard& guard_;
        const std::atomic<bool>* cancelledBefore_;
        Clock::time_point deadlineBefore_;
        bool ofPictureBefore_;
    };

    /// Seconds of the steps of a generation, if pictures are due before it ends. They can be made between two.
    static constexpr double shortStep = 0.004, longStep = 0.02;

  private:
    std::function<void()> abandoned_;
    std::function<void(std::string_view)> begins_;
    std::function<double()> step_;
    std::thread::id worker_;
    const std::atomic<bool>* cancelled_ = nullptr;
    Clock::time_point deadline_ = Clock::time_point::max();
    bool ofPicture_ = false;
    Clock::duration paused_{};
    double stepSeconds_ = longStep;
};

}  // namespace lumulus::service
