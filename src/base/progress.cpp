#include "base/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace lumulus {
namespace {

void toStderr(const std::string& text) {
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::fflush(stderr);
}

}  // namespace

std::string durationText(double seconds) {
    if (seconds < 9.95) return fmt::format("{:.1f} s", seconds);
    const auto whole = static_cast<std::uint64_t>(std::min(seconds + 0.5, 1e15));
    if (whole < 60) return fmt::format("{} s", whole);
    if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
    return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

Progress::Progress(std::string title, std::uint64_t total, bool quiet)
    : Progress(std::move(title), total, ::isatty(STDERR_FILENO) == 1, quiet ? Sink{} : Sink{toStderr}) {}

Progress::Progress(std::string title, std::uint64_t total, bool terminal, Sink sink)
    : title_(std::move(title)), total_(total), terminal_(terminal), sink_(std::move(sink)) {
    if (sink_ && total_ > 0) show(start_);
}

Progress::~Progress() {
    if (sink_ && terminal_ && shown_ && !complete_) sink_("\n");
}

void Progress::advance(std::uint64_t n) {
    done_ += n;
    if (!sink_ || complete_) return;
    const Clock::time_point now = Clock::now();
    const auto pause = terminal_ ? std::chrono::milliseconds(100) : std::chrono::milliseconds(2000);
    if (!shown_ || done_ >= total_ || now - *shown_ >= pause) show(now);
}

void Progress::show(Clock::time_point now) {
    shown_ = now;
    complete_ = total_ > 0 && done_ >= total_;
    const std::string line = text(std::chrono::duration<double>(now - start_).count());
    // \033[K clears the rest of a longer line before
    if (terminal_)
        sink_("\r" + line + "\033[K");
    else if (total_ != 1 || complete_)
        sink_(line + "\n");
    if (terminal_ && complete_) sink_("\n");
}

std::string Progress::text(double elapsed) const {
    if (total_ == 1) return complete_ ? fmt::format("{}: {}", title_, durationText(elapsed)) : title_ + " …";
    const double share = total_ == 0 ? 1.0 : std::min(1.0, static_cast<double>(done_) / static_cast<double>(total_));
    const double rate = elapsed > 0.0 ? static_cast<double>(done_) / elapsed : 0.0;
    const double left = share > 0.0 ? elapsed * (1.0 - share) / share : 0.0;
    const std::string tail = share < 1.0 ? durationText(left) + " left" : durationText(elapsed);
    const std::string speed = done_ == 0 ? "" : fmt::format(", {:.3g}/s, {}", rate, tail);
    if (!terminal_) return fmt::format("{}: {}/{} ({:.0f} %){}", title_, done_, total_, 100.0 * share, speed);
    constexpr std::size_t barWidth = 30;
    const auto filled = static_cast<std::size_t>(share * barWidth);
    return fmt::format("{} [{}{}] {}/{}{}", title_, std::string(filled, '='), std::string(barWidth - filled, ' '),
                       done_, total_, speed);
}

void Steps::report(std::string_view step, std::uint64_t done, std::uint64_t total) {
    if (!progress_ || step != name_ || done == 0) {
        name_ = step;
        done_ = 0;
        progress_.emplace(name_, total, quiet_);
    }
    if (done > done_) progress_->advance(done - done_);
    done_ = std::max(done_, done);
}

Report Steps::reporter() {
    return [this](std::string_view step, std::uint64_t done, std::uint64_t total) { report(step, done, total); };
}

}  // namespace lumulus
