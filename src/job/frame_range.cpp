#include "job/frame_range.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "base/error.h"

namespace lumulus::job {

namespace {

constexpr std::int64_t mostFrames = 1'000'000, largest = 999'999'999;

[[noreturn]] void refuse(std::string_view text, const char* why) {
    throw InputError(fmt::format("\"{}\" {}", text, why), "--frames",
                     "write FIRST-LAST or FIRST-LAST:STEP, such as 1-240");
}

std::int64_t numberIn(std::string_view& left, std::string_view text) {
    std::int64_t number = 0;
    const auto read = std::from_chars(left.data(), left.data() + left.size(), number);
    if (read.ec != std::errc() || number < 0 || number > largest) refuse(text, "names no frames");
    left.remove_prefix(static_cast<std::size_t>(read.ptr - left.data()));
    return number;
}

}  // namespace

std::vector<std::int64_t> FrameRange::numbers() const {
    std::vector<std::int64_t> all;
    for (std::int64_t frame = first; frame <= last; frame += step) all.push_back(frame);
    return all;
}

FrameRange parseFrames(std::string_view text) {
    std::string_view left = text;
    FrameRange range;
    range.first = range.last = numberIn(left, text);
    if (left.starts_with('-')) {
        left.remove_prefix(1);
        range.last = numberIn(left, text);
    }
    if (left.starts_with(':')) {
        left.remove_prefix(1);
        range.step = numberIn(left, text);
    }
    if (!left.empty()) refuse(text, "names no frames");
    if (range.step < 1) refuse(text, "has a step of 0");
    if (range.last < range.first) refuse(text, "ends before it begins");
    if ((range.last - range.first) / range.step >= mostFrames) refuse(text, "are more than 1000000 frames");
    return range;
}

std::string inWords(const std::vector<std::int64_t>& frames) {
    std::string text;
    for (std::size_t i = 0; i < frames.size();) {
        std::size_t end = i + 1;
        while (end < frames.size() && frames[end] == frames[end - 1] + 1) ++end;
        if (!text.empty()) text += ", ";
        text += end - i == 1 ? fmt::format("{}", frames[i]) : fmt::format("{}-{}", frames[i], frames[end - 1]);
        i = end;
    }
    return text;
}

}  // namespace lumulus::job
