#include "scene/schema.h"

#include <fmt/format.h>

#include <algorithm>

namespace lumulus::scene {
namespace {

std::string plain(double x) {
    return fmt::format("{:.16g}", x);
}

}  // namespace

bool Range::contains(double x) const {
    const bool aboveLow = openLow ? x > low : x >= low;
    const bool belowHigh = openHigh ? x < high : x <= high;
    return aboveLow && belowHigh;
}

std::string Range::text() const {
    if (!openLow && !openHigh) return plain(low) + "…" + plain(high);
    return (openLow ? "above " : "at least ") + plain(low) + (openHigh ? ", below " : ", at most ") + plain(high);
}

const Key* findKey(std::string_view name) {
    const auto it = std::ranges::find(schema(), name, &Key::name);
    return it == schema().end() ? nullptr : &*it;
}

bool isSection(std::string_view name) {
    const std::string prefix = std::string(name) + ".";
    return std::ranges::any_of(schema(), [&](const Key& key) { return key.name.starts_with(prefix); });
}

std::string typeText(const Key& key) {
    switch (key.type) {
        case Type::number:
            return "a number";
        case Type::integer:
            return "a whole number";
        case Type::boolean:
            return "true or false";
        case Type::vector:
            return "[x, y, z]";
        case Type::wind:
            return "[x, y, z], or rows of [height, x, y, z]";
        case Type::pair:
            return "[first, last]";
        case Type::rgb:
            return "a number or [r, g, b]";
        case Type::matrix:
            return "three or four rows of four numbers";
        case Type::text:
            return "a string";
        case Type::path:
            return "a file name";
        case Type::time:
            return "a time as 2026-06-21T10:00:00Z";
        case Type::choice:
            return fmt::format("one of \"{}\"", fmt::join(key.choices, "\", \""));
    }
    return "";
}

}  // namespace lumulus::scene
