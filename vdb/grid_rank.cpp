#include "vdb/grid_rank.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <span>
#include <vector>

namespace lumulus::vdb {
namespace {

using Text = std::string_view;

// the best first; q… are mixing ratios and l/iwc water contents of weather models
constexpr std::array<Text, 20> densities{"density", "smoke",  "cloud", "clouds", "extinction",   "lwc", "clwc",
                                         "qc",      "qcloud", "ql",    "clw",    "liquid_water", "iwc", "ciwc",
                                         "qi",      "qice",   "cli",   "fog",    "steam",        "mist"};
constexpr std::array<Text, 26> others{"temper", "heat",    "flame",    "fire",     "fuel",     "burn",     "veloc",
                                      "vapor",  "vapour",  "humid",    "pressure", "diverg",   "vortic",   "wind",
                                      "speed",  "motion",  "force",    "theta",    "collis",   "emission", "color",
                                      "colour", "surface", "distance", "levelset", "level_set"};
// whole words of a name, as v and x in v.x
constexpr std::array<Text, 22> otherWords{"v",    "u",         "w",    "t",   "vx",    "vy",  "vz",  "temp",
                                          "qv",   "q",         "p",    "cd",  "id",    "sdf", "age", "uvw",
                                          "rest", "intensity", "mask", "cfl", "react", "o2"};

/// The words of a plain name, divided by anything but letters and digits.
std::vector<Text> wordsOf(Text name) {
    std::vector<Text> words;
    const auto inWord = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; };
    for (auto first = name.begin(); (first = std::find_if(first, name.end(), inWord)) != name.end();) {
        const auto last = std::find_if_not(first, name.end(), inWord);
        words.emplace_back(first, last);
        first = last;
    }
    return words;
}

bool contains(Text name, std::span<const Text> words, Text wanted) {
    constexpr std::size_t unmistakable = 5;  // "fog" in "fogging" or "qc" in "sqcm" would be chance
    if (wanted.size() >= unmistakable) return name.find(wanted) != Text::npos;
    return std::ranges::find(words, wanted) != words.end();
}

}  // namespace

std::string plainName(std::string_view name) {
    constexpr Text spaces(" \t\r\n\v\f\0", 7);
    const std::size_t first = name.find_first_not_of(spaces);
    if (first == Text::npos) return {};
    std::string plain(name.substr(first, name.find_last_not_of(spaces) + 1 - first));
    std::ranges::transform(plain, plain.begin(),
                           [](char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); });
    return plain;
}

int nameRank(std::string_view name) {
    constexpr int containing = 100, silent = 200;
    std::string plain = plainName(name);
    std::ranges::replace_if(
        plain, [](char c) { return c == ' ' || c == '-' || c == '.'; }, '_');
    const auto exact = std::ranges::find(densities, plain);
    if (exact != densities.end()) return static_cast<int>(exact - densities.begin());
    const std::vector<Text> words = wordsOf(plain);
    const auto other = [&](Text word) { return plain.find(word) != Text::npos; };
    const auto otherWord = [&](Text word) { return std::ranges::find(words, word) != words.end(); };
    if (plain.starts_with("vel") || std::ranges::any_of(others, other) || std::ranges::any_of(otherWords, otherWord))
        return otherQuantity;
    const auto part = std::ranges::find_if(densities, [&](Text word) { return contains(plain, words, word); });
    return part != densities.end() ? containing + static_cast<int>(part - densities.begin()) : silent;
}

}  // namespace lumulus::vdb
