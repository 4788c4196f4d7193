#include "base/frame_name.h"

#include <fmt/format.h>

#include <charconv>
#include <optional>
#include <string>

namespace lumulus {

namespace {

/// Where the number stands in a name, and its least digits.
struct Place {
    std::size_t begin = 0, length = 0;
    int digits = 0;
};

std::optional<Place> placeIn(const std::string& name) {
    const std::size_t slash = name.find_last_of('/') + 1;
    if (const std::size_t last = name.find_last_of('#'); last != std::string::npos && last >= slash) {
        std::size_t begin = last;
        while (begin > slash && name[begin - 1] == '#') --begin;
        return Place{begin, last + 1 - begin, static_cast<int>(last + 1 - begin)};
    }
    for (std::size_t at = name.find('%', slash); at != std::string::npos; at = name.find('%', at + 1)) {
        const std::size_t d = name.find_first_not_of("0123456789", at + 1);
        if (d == std::string::npos || name[d] != 'd' || d - at > 3) continue;
        int digits = 0;
        std::from_chars(name.data() + at + 1, name.data() + d, digits);
        return Place{at, d + 1 - at, digits};
    }
    return std::nullopt;
}

}  // namespace

bool hasFrameNumber(const std::filesystem::path& name) {
    return placeIn(name.string()).has_value();
}

std::filesystem::path nameOfFrame(const std::filesystem::path& name, std::int64_t frame) {
    std::string text = name.string();
    if (const auto place = placeIn(text))
        text.replace(place->begin, place->length, fmt::format("{:0{}}", frame, place->digits));
    return text;
}

}  // namespace lumulus
