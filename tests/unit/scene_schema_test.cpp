#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "base/error.h"
#include "scene/arrays.h"
#include "scene/document.h"
#include "scene/load.h"
#include "scene/schema.h"
#include "scene/suggest.h"
#include "support/temporary_folder.h"

// What holds for every row of the table of keys.
namespace lumulus::scene {
namespace {

using testing::HasSubstr;

std::string companionOfLamp(std::string_view name) {
    std::string others;
    if (name == "temperature") others += "lumens = 1000\n";
    if (name != "temperature" && name != "lumens" && name != "power") others += "power = 1\n";
    const bool aims = name == "direction" || name == "target";
    if (aims || name == "angle" || name == "softness") others += "kind = \"spot\"\n";
    if (name == "angle" || name == "softness") others += "target = [0, -1, 0]\n";
    return others;
}

/// What a key needs beside it to have an effect.
std::string companionOf(const Key& key) {
    const std::string_view name = key.name.substr(key.name.rfind('.') + 1);
    if (name == "effective_radius" || name == "effective_variance") return "phase.model = \"mie\"\n";
    if (key.name.starts_with("time.")) {
        std::string others;
        if (name != "utc") others += "utc = \"2026-06-21T10:00:00Z\"\n";
        if (name != "latitude") others += "latitude = 50.0\n";
        if (name != "longitude") others += "longitude = 15.0\n";
        return others;
    }
    const std::set<std::string_view> ofAir{"sky.preset", "sky.aerosol_depth", "sky.angstrom", "sky.ozone",
                                           "sky.ground_albedo"};
    if (ofAir.contains(key.name)) return "model = \"atmosphere\"\n";
    const std::set<std::string_view> ofMap{"sky.map_scale", "sky.map_rotation", "sky.map_sun"};
    if (ofMap.contains(key.name)) return "model = \"map\"\n";
    if (key.name == "ground.albedo") return "height = 0.0\n";
    if (key.name == "ground.height") return "albedo = 0.2\n";
    if (key.name.starts_with("lamp.")) return companionOfLamp(name);
    if (key.name.starts_with("mesh."))
        return name == "gltf" ? "" : "gltf = \"" SOURCE_ROOT "/configs/scenes/aircraft.glb\"\n";
    if (name == "droplet_diameter") return "phase.model = \"droplet\"\n";
    if (key.name == "cloud.offset") return "";
    if (name == "falloff" || name == "direction" || name == "offset") return "kind = \"exponential\"\n";
    if (key.name == "field.smallest") return "largest = 1e6\n";
    if (key.name == "field.largest") return "smallest = 1.0\n";
    if (key.name.starts_with("field.")) return "";
    if (name == "center" || name == "radius") return "kind = \"sphere\"\n";
    if (name == "aerosol" || key.name == "fog.media.albedo") return "visibility = 1000\n";
    if (name == "half_size") return "kind = \"box\"\n";
    return "";
}

/// The line that begins the key's section (the entry, in an array) and the path to it.
std::pair<std::string, std::string> sectionOf(const Key& key) {
    if (const ArraySection* array = arrayOf(key.name))
        return {fmt::format("[[{}]]\n", array->name), std::string(array->name)};
    const std::string section(key.name.substr(0, key.name.find('.')));
    return {fmt::format("[{}]\n", section), section};
}

/// `key = value` in its section.
std::string documentOf(const Key& key, const std::string& value) {
    const auto [head, section] = sectionOf(key);
    return fmt::format("{}{} = {}\n{}", head, key.name.substr(section.size() + 1), value, companionOf(key));
}

std::string pathOf(const Key& key) {
    const ArraySection* array = arrayOf(key.name);
    if (array == nullptr) return std::string(key.name);
    return fmt::format("{}.0{}", array->name, key.name.substr(array->name.size()));
}

std::string messageOf(const std::string& toml) {
    try {
        parseScene(toml, "x.toml");
    } catch (const InputError& e) {
        return e.what();
    }
    return "no error";
}

class EveryKey : public testing::TestWithParam<Key> {};

TEST_P(EveryKey, DocumentedDefaultIsTheDefault) {
    const Key& key = GetParam();
    if (key.fallback.starts_with('(')) {
        EXPECT_TRUE(key.fallback.ends_with(')'));
        return;
    }
    const std::string without = sectionOf(key).first + companionOf(key);
    EXPECT_EQ(parseScene(documentOf(key, std::string(key.fallback)), "x.toml"), parseScene(without, "x.toml"));
}

TEST_P(EveryKey, WrongTypeNamesKeyAndLine) {
    const Key& key = GetParam();
    const std::string name(key.name.substr(key.name.rfind('.') + 1));
    const bool takesText = key.type == Type::text || key.type == Type::path || key.type == Type::choice;
    const char* flag = key.type == Type::boolean ? "1" : "true";
    for (const char* value : {flag, "1979-05-27", "{ a = 1 }", "[]", "[[]]", takesText ? "3" : "\"three\""}) {
        const std::string message = messageOf(documentOf(key, value));
        EXPECT_THAT(message, HasSubstr(name + " must be ")) << value;
        EXPECT_THAT(message, HasSubstr("(x.toml:2, " + pathOf(key) + ")")) << value;
    }
}

TEST_P(EveryKey, NotANumberIsRefused) {
    const Key& key = GetParam();
    for (const char* value : {"nan", "inf", "-inf"}) {
        std::string text = value;
        if (key.type == Type::vector || key.type == Type::wind || key.type == Type::rgb)
            text = fmt::format("[0.5, {}, 0.5]", value);
        if (key.type == Type::matrix) text = fmt::format("[[1,0,0,{}],[0,1,0,0],[0,0,1,0]]", value);
        EXPECT_THAT(messageOf(documentOf(key, text)), HasSubstr(pathOf(key))) << text;
    }
}

TEST_P(EveryKey, OutOfRangeIsRefusedAndTheEndsFollowTheDocumentation) {
    const Key& key = GetParam();
    if (key.type != Type::number && key.type != Type::integer && key.type != Type::rgb) return;
    const std::string below = key.type == Type::integer
                                  ? fmt::format("{}", static_cast<std::int64_t>(key.range.low) - 1)
                                  : fmt::format("{:.17g}", key.range.low - 1e-3 - 1e-9);
    EXPECT_THAT(messageOf(documentOf(key, below)), HasSubstr(", got ")) << below;
    const std::string above = fmt::format("{:.1f}", key.range.high * 1.001 + 1.0);
    EXPECT_THAT(messageOf(documentOf(key, above)), HasSubstr(", got ")) << above;
    EXPECT_EQ(messageOf(documentOf(key, fmt::format("{:.1f}", key.range.high))) == "no error", !key.range.openHigh);
    EXPECT_EQ(messageOf(documentOf(key, fmt::format("{:.2f}", key.range.low))) == "no error", !key.range.openLow);
}

TEST_P(EveryKey, IntegersAreNumbers) {
    const Key& key = GetParam();
    if (key.type != Type::number && key.type != Type::rgb) return;
    for (const int value : {0, 1, 10}) {
        const bool valid = messageOf(documentOf(key, std::to_string(value))) == "no error";
        EXPECT_EQ(valid, key.range.contains(value)) << value;
    }
}

TEST_P(EveryKey, HasASetterAndWordsAboutIt) {
    const Key& key = GetParam();
    EXPECT_NE(key.set, nullptr);
    EXPECT_FALSE(key.documentation.empty());
    EXPECT_EQ(key.documentation.find('|'), std::string::npos);  // it would break the table
    EXPECT_EQ(key.type == Type::choice, !key.choices.empty());
    EXPECT_EQ(findKey(key.name)->set, key.set);
}

TEST_P(EveryKey, ChoicesAreExactlyThese) {
    const Key& key = GetParam();
    for (const std::string_view choice : key.choices) {
        if (key.name == "lamp.kind" && choice != "point") {
            EXPECT_THAT(messageOf(documentOf(key, fmt::format("\"{}\"", choice))), HasSubstr("neither target nor"));
            continue;
        }
        if (choice == "table") {
            EXPECT_THAT(messageOf(documentOf(key, "\"table\"")), HasSubstr("needs a file"));
            continue;
        }
        EXPECT_EQ(messageOf(documentOf(key, fmt::format("\"{}\"", choice))), "no error");
    }
    if (key.type != Type::choice) return;
    EXPECT_THAT(messageOf(documentOf(key, "\"neither\"")), HasSubstr("got \"neither\""));
}

INSTANTIATE_TEST_SUITE_P(Schema, EveryKey, testing::ValuesIn(schema()), [](const auto& row) {
    std::string name(row.param.name);
    for (char& c : name) c = c == '.' ? '_' : c;
    return name;
});

TEST(Schema, NamesAreUniqueAndSectionsAreTogether) {
    std::set<std::string_view> names, sections;
    std::string_view last;
    for (const Key& key : schema()) {
        EXPECT_TRUE(names.insert(key.name).second) << key.name;
        const std::string_view section = key.name.substr(0, key.name.rfind('.'));
        EXPECT_TRUE(section == last || sections.insert(section).second) << section;
        last = section;
    }
}

TEST(Schema, DefaultsOfTheStructsAreThoseOfAFileWithAConstantSky) {
    Scene scene;
    scene.clouds.resize(1);
    scene.source = "x.toml";
    EXPECT_EQ(parseScene("[sky]\nmodel = \"constant\"\n", "x.toml"), scene);
}

TEST(Schema, DocumentationIsUpToDate) {
    EXPECT_EQ(test::readAll(SOURCE_ROOT "/docs/scene-format.md"), sceneFormatMarkdown())
        << "lumulus info --scene-format > docs/scene-format.md";
}

TEST(Schema, ScenesThatShipAreValid) {
    int scenes = 0;
    for (const auto& entry : std::filesystem::directory_iterator(SOURCE_ROOT "/configs/scenes")) {
        if (entry.path().extension() != ".toml") continue;
        ++scenes;
        std::vector<std::string> overrides;
        // files of data do not come with the sources
        if (test::readAll(entry.path()).find("\nvdb") != std::string::npos) {
            overrides.emplace_back("cloud.0.procedural=cumulus");
        }
        EXPECT_NO_THROW(loadScene(entry.path(), overrides)) << entry.path();
    }
    EXPECT_GE(scenes, 3);
}

TEST(Suggest, NearestKey) {
    EXPECT_EQ(suggestKey("image.widht"), "did you mean \"width\"?");
    EXPECT_EQ(suggestKey("imag"), "did you mean \"image\"?");
    EXPECT_EQ(suggestKey("cloud.albdeo"), "did you mean \"albedo\"?");
    EXPECT_EQ(suggestKey("cloud.g"), "did you mean cloud.phase.g?");
    EXPECT_EQ(suggestKey("image.zzzzzz"),
              "the keys of image are background, ev100, exposure, exposure_mode, height, tone_map, width");
    EXPECT_EQ(suggestKey("image.extinction"), "did you mean extinction in [[cloud]]?");
    EXPECT_THAT(suggestKey("zzzzzz"), HasSubstr("the sections are camera, cloud, draw, field, fog, ground, image"));
}

TEST(Suggest, EditDistance) {
    EXPECT_EQ(editDistance("", "abc"), 3U);
    EXPECT_EQ(editDistance("kitten", "sitting"), 3U);
    EXPECT_EQ(editDistance("widht", "width"), 1U);
}

}  // namespace
}  // namespace lumulus::scene
