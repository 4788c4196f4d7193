#pragma once

#include <string_view>
#include <utility>
#include <vector>

#include "scene/schema.h"

/// How a row of the table of keys is written, by type.
namespace lumulus::scene {

using Setter = void (*)(Draft&, const Value&);
using Text = std::string_view;

inline constexpr Range unit{0.0, 1.0};
inline constexpr Range light{0.0, 1e9};
inline constexpr Range coefficients{0.0, 1e6};
inline constexpr Range seeds{0.0, 9007199254740992.0};  // 2^53: larger integers are not exact in every reader

inline Key number(Text name, Range range, Text fallback, Text documentation, Setter set) {
    return {name, Type::number, range, {}, fallback, documentation, set};
}

inline Key integer(Text name, Range range, Text fallback, Text documentation, Setter set) {
    return {name, Type::integer, range, {}, fallback, documentation, set};
}

inline Key rgb(Text name, Range range, Text fallback, Text documentation, Setter set) {
    return {name, Type::rgb, range, {}, fallback, documentation, set};
}

inline Key choice(Text name, std::vector<Text> choices, Text fallback, Text documentation, Setter set) {
    return {name, Type::choice, {}, std::move(choices), fallback, documentation, set};
}

inline Key other(Text name, Type type, Text fallback, Text documentation, Setter set) {
    return {name, type, {}, {}, fallback, documentation, set};
}

/// Rows of other files.
std::vector<Key> groundKeys();
std::vector<Key> detailKeys();
std::vector<Key> sequenceKeys();
std::vector<Key> mapKeys();
std::vector<Key> sunAndSkyKeys();
std::vector<Key> atmosphereKeys();
std::vector<Key> timeKeys();        ///< time, moon, and what of the sun goes with them
std::vector<Key> phaseKeys();       ///< of clouds
std::vector<Key> fieldPhaseKeys();  ///< the same of fields
std::vector<Key> fieldKeys();
std::vector<Key> storageKeys();
std::vector<Key> fogKeys();
std::vector<Key> mediumKeys();
std::vector<Key> lampKeys();
std::vector<Key> meshKeys();

}  // namespace lumulus::scene
