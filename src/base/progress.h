#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace lumulus {

/// Long work tells of it: the name of a step, and how much of it is done. Called by the thread that asked for the work.
using Report = std::function<void(std::string_view step, std::uint64_t done, std::uint64_t total)>;

/// The Report of those who do not want to know.
inline void noReport(std::string_view, std::uint64_t, std::uint64_t) {}

/// Shows how far long work is: a bar with rate and time left on a terminal, plain lines when piped (the first, the
/// last, and at most one every two seconds), nothing when quiet. Work of a single step (total 1) shows no bar, and when
/// piped only the time it took. Not for several threads.
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
    /// Ends the line of a bar whose work stopped early.
    ~Progress();

    void advance(std::uint64_t n = 1);

  private:
    void show(Clock::time_point now);
    std::string text(double elapsed) const;

    std::string title_;
    std::uint64_t total_;
    std::uint64_t done_ = 0;
    bool terminal_;
    Sink sink_;  ///< empty: quiet
    Clock::time_point start_ = Clock::now();
    std::optional<Clock::time_point> shown_;
    bool complete_ = false;
};

/// Shows the steps that a Report tells of, each by a Progress of its own.
class Steps {
  public:
    explicit Steps(bool quiet) : quiet_(quiet) {}

    /// A step begins with `done` 0, or with a name that is not the last one's.
    void report(std::string_view step, std::uint64_t done, std::uint64_t total);
    /// For those who do the work; this object has to outlive it.
    Report reporter();

  private:
    bool quiet_;
    std::string name_;
    std::uint64_t done_ = 0;
    std::optional<Progress> progress_;
};

/// Seconds for people: "0.4 s", "12 s", "3 min 05 s", "2 h 07 min".
std::string durationText(double seconds);

}  // namespace lumulus
