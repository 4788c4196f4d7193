#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.h"

namespace lumulus::scene {

enum class Type { number, integer, boolean, vector, wind, pair, rgb, matrix, text, path, time, choice };

/// The range of a number, or of each component of a vector. NaN and infinity are always outside.
struct Range {
    double low = -1e9;
    double high = 1e9;
    bool openLow = false;
    bool openHigh = false;

    bool contains(double x) const;
    std::string text() const;  ///< "0…1", "above 0, at most 90"
};

/// The value of one key, in the member that fits the key's type.
struct Value {
    double number = 0.0;
    std::int64_t integer = 0;
    bool boolean = false;
    glm::dvec3 vector{0.0};  ///< also RGB; x and y of a pair
    glm::dmat4 matrix{1.0};
    Wind wind;
    std::string text;        ///< also a choice or a time
    std::size_t choice = 0;  ///< index into the choices of the key
};

/// A scene whose keys are being read one by one.
struct Draft {
    Scene scene;
    std::size_t entry = 0;                           ///< index in the array section of the key
    std::filesystem::path folder;                    ///< folder of the scene file, where relative paths start
    std::span<const std::filesystem::path> allowed;  ///< folders in which files may lie; empty: everywhere
    std::optional<glm::dvec3> directionTo;
    std::optional<double> azimuth, elevation;  ///< sun, degrees
    std::optional<std::size_t> skyPreset;      ///< of the air, which keys of their own change
    std::optional<double> moonAzimuth, moonElevation;
    double frame = 0.0, fps = 24.0;                 ///< of the animation
    std::map<std::size_t, std::size_t> aerosols;    ///< by the index of the fog medium
    std::map<std::size_t, glm::dvec3> fogAlbedos;   ///< the same
    std::map<std::size_t, glm::dvec3> lampTargets;  ///< by the index of the lamp
    std::map<std::size_t, double> lampLumens, lampTemperatures;
};

/// One key of the scene file. The parser, its messages and docs/scene-format.md all come from these rows.
struct Key {
    std::string_view name;  ///< "section.key"; those of [[cloud]] are "cloud.key", without the index
    Type type;
    Range range;
    std::vector<std::string_view> choices;
    std::string_view fallback;  ///< default as TOML, or in words within parentheses
    std::string_view documentation;
    void (*set)(Draft&, const Value&);
};

/// All keys, section by section.
const std::vector<Key>& schema();

/// The key of that name, or null.
const Key* findKey(std::string_view name);

/// True for "image", "cloud", "cloud.phase", …
bool isSection(std::string_view name);

/// The type of a key's values in words: "a number", "one of \"march\", \"billboards\"".
std::string typeText(const Key& key);

}  // namespace lumulus::scene
