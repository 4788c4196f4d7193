#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace lumulus {

/// Long work calls a Report with the name of a step and its progress, on the thread that requested the work.
using Report = std::function<void(std::string_view step, std::uint64_t done, std::uint64_t total)>;

/// A Report that does nothing.
inline void noReport(std::string_view, std::uint64_t, std::uint64_t) {}

/// Shows the progress of long work: a bar with rate and time left on a terminal, plain lines when piped (the first, the
/// last, and at most one every two seconds), nothing when quiet. Work of a single step (total 1) shows no bar, and when
/// piped only its duration. Not thread-safe.
class Progress {
  public:
    using Clock = std::chrono::steady_clock;
    using Sink = std::function<void(const std::string&)>;

    /// Shows progress on stderr. `total` has the unit of `advance`.
    Progress(std::string title, std::uint64_t total, bool quiet);
    /// Shows progress through a sink of the caller.
    Progress(std::string title, std::uint64_t total, bool terminal, Sink sink);
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    /// Ends the line of a bar if the work stopped early.
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

/// Shows the steps of a Report, each with a Progress of its own.
class Steps {
  public:
    explicit Steps(bool quiet) : quiet_(quiet) {}

    /// Shows the progress of a step. A new step begins when `done` is 0 or when the name changes.
    void report(std::string_view step, std::uint64_t done, std::uint64_t total);
    /// The Report that calls report(). This object has to outlive it.
    Report reporter();

  private:
    bool quiet_;
    std::string name_;
    std::uint64_t done_ = 0;
    std::optional<Progress> progress_;
};

/// Formats seconds for people: "0.4 s", "12 s", "3 min 05 s", "2 h 07 min".
std::string durationText(double seconds);

}  // namespace lumulus
