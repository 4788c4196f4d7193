#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "base/error.h"
#include "scene/load.h"
#include "scene/toml_guard.h"
#include "support/temporary_folder.h"

// Text that nobody would write: it parses or it is bad input, and nothing else happens.
namespace lumulus::scene {
namespace {

const std::string validScene = R"(# a scene
[image]
width = 640
exposure = 0.5
[camera]
position = [0.0, 50.0, 300.0]
target = [0.0, 100.0, 0.0]
projection = 'orthographic'
[sun]
azimuth = 30
elevation = 20.5
[[cloud]]
procedural = "sphere"
albedo = [1.0, 0.99, 0.98]
phase = { model = "droplet", droplet_diameter = 20 }
transform = [[1, 0, 0, 1e7],
             [0, 1, 0, 0],  # a comment
             [0, 0, 1, 0]]
[photon_map]
photons = 100_000
majorant = """local"""
)";

enum class Outcome { parsed, badInput };

Outcome outcomeOf(const std::string& text) {
    try {
        parseScene(text, "hostile.toml");
        return Outcome::parsed;
    } catch (const InputError& e) {
        EXPECT_STRNE(e.what(), "");
        return Outcome::badInput;
    }
}

TEST(HostileScene, TruncatedAtEveryByte) {
    ASSERT_EQ(outcomeOf(validScene), Outcome::parsed);
    int parsed = 0, bad = 0;
    for (std::size_t length = 0; length < validScene.size(); ++length) {
        (outcomeOf(validScene.substr(0, length)) == Outcome::parsed ? parsed : bad) += 1;
    }
    EXPECT_GT(parsed, 0);
    EXPECT_GT(bad, 0);
}

TEST(HostileScene, EveryByteReplaced) {
    std::uint32_t state = 12345;
    for (std::size_t i = 0; i < validScene.size(); ++i) {
        for (const char byte : {'\0', '"', '[', '{', '.', '=', '\n', '9', '\xff'}) {
            std::string text = validScene;
            text[i] = byte;
            outcomeOf(text);
        }
        std::string text = validScene;
        state = state * 1664525U + 1013904223U;
        text[i] = static_cast<char>(state >> 24);
        outcomeOf(text);
    }
}

TEST(HostileScene, DeepNesting) {
    const auto repeated = [](const std::string& text, int times) {
        std::string all;
        for (int i = 0; i < times; ++i) all += text;
        return all;
    };
    EXPECT_EQ(outcomeOf("a = " + repeated("[", 100000)), Outcome::badInput);
    EXPECT_EQ(outcomeOf("a = " + repeated("{a=", 100000)), Outcome::badInput);
    EXPECT_EQ(outcomeOf(repeated("a.", 300000) + "a = 1"), Outcome::badInput);
    EXPECT_EQ(outcomeOf("[" + repeated("a.", 300000) + "a]"), Outcome::badInput);
    EXPECT_EQ(outcomeOf(repeated("\"a\" . ", 100000) + "a = 1"), Outcome::badInput);
    // as deep as both limits let it: the tables must still destroy themselves
    EXPECT_EQ(outcomeOf("a = " + repeated("[{a.a.a.a.a.a.a.a=", 120) + "1" + repeated("}]", 120)), Outcome::badInput);
}

TEST(HostileScene, KeyDepthCountsDotsOfKeysOnly) {
    EXPECT_NO_THROW(checkKeyDepth("a.b.c = [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0]", "x"));
    EXPECT_NO_THROW(checkKeyDepth("vdb = \"../../../../../../a.b.c\"", "x"));
    EXPECT_NO_THROW(checkKeyDepth("vdb = '''\n...........\n''' # ............", "x"));
    EXPECT_NO_THROW(checkKeyDepth("vdb = \"\\\"...........\"", "x"));
    EXPECT_THROW(checkKeyDepth("a.a.a.a.a.a.a.a.a.a = 1", "x"), InputError);
    EXPECT_THROW(checkKeyDepth("\n[a.a.a.a.a.a.a.a.a.a]", "x"), InputError);
    EXPECT_THROW(checkKeyDepth("a = \"\"\na.a.a.a.a.a.a.a.a.a = 1", "x"), InputError);
}

TEST(HostileScene, TooLarge) {
    const test::TemporaryFolder folder;
    test::writeAll(folder / "big.toml", std::string((1U << 20) + 1, '#'));
    EXPECT_THROW(loadScene(folder / "big.toml"), InputError);
    test::writeAll(folder / "fits.toml", std::string(1U << 20, '#'));
    EXPECT_NO_THROW(loadScene(folder / "fits.toml"));
}

TEST(HostileScene, OddBytes) {
    EXPECT_EQ(outcomeOf(std::string("\0", 1)), Outcome::badInput);
    EXPECT_EQ(outcomeOf("\xef\xbb\xbf[image]\nwidth = 3"), Outcome::parsed);  // byte order mark
    EXPECT_EQ(outcomeOf("[image]\r\nwidth = 3\r\n"), Outcome::parsed);
    EXPECT_EQ(outcomeOf("\xc3\x28 = 1"), Outcome::badInput);
    EXPECT_EQ(outcomeOf("\"" + std::string(500000, 'x') + "\" = 1"), Outcome::badInput);
    EXPECT_EQ(outcomeOf("[ = 32.0\n"), Outcome::badInput);
    EXPECT_EQ(outcomeOf("a = { b  \u00b2 = 1 }"), Outcome::badInput);
    EXPECT_EQ(outcomeOf("[image]\nwidth = 99999999999999999999"), Outcome::badInput);
    EXPECT_EQ(outcomeOf("[image]\nexposure = 1e999"), Outcome::badInput);
    EXPECT_EQ(outcomeOf("[[cloud]]\nvdb = \"a\\u0000b\""), Outcome::badInput);
}

}  // namespace
}  // namespace lumulus::scene
