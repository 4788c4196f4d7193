#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/error.h"
#include "scene/black_body.h"
#include "scene/load.h"
#include "support/scene_message.h"

namespace lumulus::scene {
namespace {

using testing::HasSubstr;

using test::sceneMessage;

/// Message of a scene with one lamp.
std::string lampMessage(const std::string& keys) {
    return sceneMessage("[[lamp]]\n" + keys);
}

TEST(SceneLamp, AllKeysAreRead) {
    const std::vector<Lamp> lamps = parseScene(R"(
[[lamp]]
position = [1, 2, 3]
power = [10, 20, 30]
[[lamp]]
name = "beam"
kind = "spot"
position = [0, 10, 0]
target = [0, 6, 3]
angle = 12
softness = 0.25
radius = 0.5
lumens = 68300
[[lamp]]
kind = "pyramid"
direction = [0, 0, -4]
power = 5
on = false
)",
                                               "x.toml")
                                        .lamps;
    ASSERT_EQ(lamps.size(), 3U);
    EXPECT_EQ(lamps[0].kind, LampKind::point);
    EXPECT_EQ(lamps[0].position, glm::dvec3(1.0, 2.0, 3.0));
    EXPECT_EQ(lamps[0].power, glm::dvec3(10.0, 20.0, 30.0));
    EXPECT_EQ(lamps[0].radius, 0.1) << "the default";
    EXPECT_TRUE(lamps[0].shines());
    EXPECT_EQ(lamps[1].name, "beam");
    EXPECT_EQ(lamps[1].direction, glm::dvec3(0.0, -0.8, 0.6));
    EXPECT_EQ(lamps[1].angle, 12.0);
    EXPECT_EQ(lamps[1].softness, 0.25);
    EXPECT_EQ(lamps[1].radius, 0.5);
    EXPECT_NEAR(lamps[1].power.y, 100.0, 1e-12) << "white without a temperature";
    EXPECT_EQ(lamps[2].kind, LampKind::pyramid);
    EXPECT_EQ(lamps[2].direction, glm::dvec3(0.0, 0.0, -1.0));
    EXPECT_FALSE(lamps[2].shines());
    EXPECT_TRUE(parseScene("", "x.toml").lamps.empty());
}

TEST(SceneLamp, OverridesAndAnimationsReachOneByIndexAndByName) {
    const char* text = "[[lamp]]\nname = \"beam\"\nlumens = 100\n[animate]\n\"lamp.0.power\" = [[0, 1.0], [10, 3.0]]\n";
    EXPECT_EQ(parseScene(text, "x.toml", std::vector<std::string>{"lamp.beam.radius=2"}).lamps[0].radius, 2.0);
    EXPECT_EQ(parseScene(text, "x.toml", {}, std::nullopt, {}, 5.0).lamps[0].power, glm::dvec3(2.0));
    EXPECT_TRUE(parseScene(text, "x.toml", std::vector<std::string>{"lamp=[]"}).lamps.empty());
}

TEST(SceneLamp, BlackBodiesHaveTheirChromaticity) {
    // points of the Planckian locus (CIE 15:2004, second radiation constant 1.4388e-2 m K)
    EXPECT_LT(glm::distance(blackBodyChromaticity(2000.0), glm::dvec2(0.5267, 0.4133)), 0.005);
    EXPECT_LT(glm::distance(blackBodyChromaticity(2856.0), glm::dvec2(0.4476, 0.4074)), 0.005);
    EXPECT_LT(glm::distance(blackBodyChromaticity(6500.0), glm::dvec2(0.3135, 0.3237)), 0.005);
    EXPECT_LT(glm::distance(blackBodyChromaticity(10000.0), glm::dvec2(0.2807, 0.2884)), 0.005);
}

TEST(SceneLamp, LumensAreTheLuminanceWhateverTheColour) {
    for (const double temperature : {1000.0, 2700.0, 6500.0, 40000.0}) {
        const std::string keys = "lumens = 800\ntemperature = " + std::to_string(temperature);
        const glm::dvec3 power = parseScene("[[lamp]]\n" + keys, "x.toml").lamps[0].power;
        EXPECT_NEAR(683.0 * glm::dot(power, glm::dvec3(0.2126390, 0.7151687, 0.0721923)), 800.0, 1e-6) << temperature;
        EXPECT_EQ(power.x > power.z, temperature < 6600.0);
    }
}

TEST(SceneLamp, BadInputIsNamed) {
    EXPECT_THAT(lampMessage("power = 1\nradius = 0"), HasSubstr("radius must be above 0"));
    EXPECT_THAT(lampMessage("power = 1\nkind = \"spot\"\ntarget = [0, -1, 0]\nangle = 0"),
                HasSubstr("angle must be above 0"));
    EXPECT_THAT(lampMessage("power = 1\nkind = \"spot\"\ntarget = [0, -1, 0]\nangle = 181"),
                HasSubstr("angle must be above 0, at most 180, got 181"));
    EXPECT_THAT(lampMessage("power = 1\nlumens = 1"), HasSubstr("lamp.0.power and lamp.0.lumens exclude each other"));
    EXPECT_THAT(lampMessage("power = nan"), HasSubstr("lamp.0.power"));
    EXPECT_THAT(lampMessage("radius = 1"), HasSubstr("neither power nor lumens"));
    EXPECT_THAT(lampMessage("power = 1\ntemperature = 3000"), HasSubstr("temperature needs lumens"));
    EXPECT_THAT(lampMessage("power = 1\nkind = \"spot\""), HasSubstr("neither target nor direction"));
    EXPECT_THAT(lampMessage("power = 1\nkind = \"spot\"\ntarget = [0, 0, 0]"), HasSubstr("are the same point"));
    EXPECT_THAT(lampMessage("power = 1\nkind = \"spot\"\ndirection = [0, 0, 0]"), HasSubstr("must have a length"));
    EXPECT_THAT(lampMessage("power = 1\nkind = \"spot\"\ndirection = [0, 0, 1]\ntarget = [0, 0, 1]"),
                HasSubstr("exclude each other"));
    EXPECT_THAT(lampMessage("power = 1\nangle = 20"), HasSubstr("angle has no effect"));
    EXPECT_THAT(lampMessage("power = 1\nname = \"power\""), HasSubstr("cannot be the name of a lamp"));
    EXPECT_THAT(lampMessage("power = 1\nname = \"a\"\n[[lamp]]\npower = 1\nname = \"a\""), HasSubstr("already"));
}

TEST(SceneLamp, TheEyeIsNotInALamp) {
    const std::string lamp = "[[lamp]]\npower = 1\nposition = [0, 2, 0]\nradius = 1\n";
    EXPECT_THAT(sceneMessage(lamp + "[camera]\nposition = [0.5, 2, 0]\ntarget = [9, 2, 0]"),
                HasSubstr("the camera's eye is within lamp.0"));
    EXPECT_NO_THROW(parseScene(lamp + "[camera]\nposition = [1.5, 2, 0]\ntarget = [9, 2, 0]", "x.toml"));
}

}  // namespace
}  // namespace lumulus::scene
