#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace lumulus {

/// Shows how far long work is: a bar with rate and time left on a terminal, plain lines when piped (the first, the
/// last, and at most one every two seconds), nothing when quiet. Not for several threads.
class Progress {
  public:
    using Clock = std::chrono::steady_clock;
    using Sink = std::function<void(const std::string&)>;

    /// On stderr. `total` in the unit of `advance`.
    Progress(std::string title, std::uint64_t total, bool quiet);
    /// To a sink of the caller's.
    Progress(std::string title, std::uint64_t total, bool terminal, Sink sink);
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    /// Ends the line of the bar, also where the work stopped early.
    ~Progress();

    void advance(std::uint64_t n = 1);

  private:
    void show(Clock::time_point now);

    std::string title_;
    std::uint64_t total_;
    std::uint64_t done_ = 0;
    bool terminal_;
    Sink sink_;  ///< empty: quiet
    Clock::time_point start_ = Clock::now();
    std::optional<Clock::time_point> shown_;
};

/// Seconds for people: "0.4 s", "12 s", "3 min 05 s", "2 h 07 min".
std::string durationText(double seconds);

}  // namespace lumulus
