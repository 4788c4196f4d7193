#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lumulus::job {

/// Frames from `first` to `last`, every `step`-th.
struct FrameRange {
    std::int64_t first = 0, last = 0, step = 1;

    std::vector<std::int64_t> numbers() const;
};

/// Reads "A-B", "A-B:STEP" or "A". Errors: InputError.
FrameRange parseFrames(std::string_view text);

/// "3, 7-9": numbers in words, those that follow each other together.
std::string inWords(const std::vector<std::int64_t>& frames);

}  // namespace lumulus::job
