#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "scene/aerosol.h"
#include "scene/fog_bounds.h"
#include "scene/load.h"
#include "support/scene_message.h"

namespace lumulus::scene {
namespace {

using testing::AllOf;
using testing::HasSubstr;

using test::sceneMessage;

TEST(SceneFog, MediaAddUpInTheOrderOfTheFile) {
    const Fog fog = parseScene(R"(
[[fog.media]]
visibility = 3912
[[fog.media]]
kind = "exponential"
scattering = [0.1, 0.2, 0.3]
absorption = 0.05
direction = [0, 0, 2]
offset = [1, 2, 3]
[fog]
filter = "gather"
separation = { strength = 0.5 }
)",
                               "x.toml")
                        .fog;
    ASSERT_EQ(fog.media.size(), 2U);
    EXPECT_DOUBLE_EQ(fog.media[0].scattering.y, 0.001);  // Koschmieder's 3.912 / visibility
    EXPECT_EQ(fog.media[0].absorption, glm::dvec3(0.0));
    EXPECT_EQ(fog.media[1].kind, MediumKind::exponential);
    EXPECT_EQ(fog.media[1].scattering, glm::dvec3(0.1, 0.2, 0.3));
    EXPECT_EQ(fog.media[1].absorption, glm::dvec3(0.05));
    EXPECT_EQ(fog.media[1].direction, glm::dvec3(0.0, 0.0, 1.0));
    EXPECT_EQ(fog.filter, FogFilter::gather);
    EXPECT_EQ(fog.separation, 0.5);
}

TEST(SceneFog, WithoutMediaThereIsNoFog) {
    EXPECT_TRUE(parseScene("", "x.toml").fog.media.empty());
    EXPECT_TRUE(parseScene("[fog]\nmedia = []", "x.toml").fog.media.empty());
    EXPECT_TRUE(parseScene("[[fog.media]]", "x.toml", std::vector<std::string>{"fog.media=[]"}).fog.media.empty());
}

TEST(SceneFog, OverridesReachOneMediumAndMayAddTheNext) {
    const std::vector<std::string> overrides{"fog.media.0.g=0.5", "fog.media.1.visibility=100"};
    const Fog fog = parseScene("[[fog.media]]\nscattering = 0.1", "x.toml", overrides).fog;
    ASSERT_EQ(fog.media.size(), 2U);
    EXPECT_EQ(fog.media[0].g, 0.5);
    EXPECT_DOUBLE_EQ(fog.media[1].scattering.x, 0.03912);
    EXPECT_THAT(sceneMessage("", {"fog.media.1.g=0"}), HasSubstr("there is no fog.media.0"));
    EXPECT_THAT(sceneMessage("", {"fog.media.g=0"}), HasSubstr("write fog.media.0.g"));
    EXPECT_THAT(sceneMessage("", {"fog.media.x.g=0"}), HasSubstr("write fog.media.0.g"));
    EXPECT_THAT(sceneMessage("", {"fog.media.99999999999.g=0"}), HasSubstr("at most 256 media"));
}

TEST(SceneFog, AnOverriddenVisibilityReplacesTheFilesCoefficients) {
    const std::vector<std::string> overrides{"fog.media.0.visibility=3912"};
    const Fog fog = parseScene("[[fog.media]]\nscattering = 0.5\nabsorption = 0.5", "x.toml", overrides).fog;
    EXPECT_DOUBLE_EQ(fog.media.at(0).scattering.x, 0.001);
    EXPECT_EQ(fog.media.at(0).absorption, glm::dvec3(0.0));
}

TEST(SceneFog, VisibilityAndCoefficientsExcludeEachOther) {
    for (const char* key : {"scattering", "absorption"}) {
        EXPECT_THAT(sceneMessage(std::string("[[fog.media]]\n[[fog.media]]\nvisibility = 10\n") + key + " = 1"),
                    AllOf(HasSubstr("exclude each other"), HasSubstr(std::string("x.toml:4, fog.media.1.") + key)));
    }
}

TEST(SceneFog, KeysThatTheKindDoesNotHaveAreRefused) {
    EXPECT_THAT(sceneMessage("[[fog.media]]\nfalloff = 1"), HasSubstr("falloff has no effect"));
    EXPECT_THAT(sceneMessage("[[fog.media]]\nkind = \"exponential\"\nradius = 1"), HasSubstr("radius has no effect"));
    EXPECT_THAT(sceneMessage("[[fog.media]]\nkind = \"sphere\"\nradius = 1", {"fog.media.0.kind=homogeneous"}),
                HasSubstr("no error"));
    EXPECT_THAT(sceneMessage("[[fog.media]]\nkind = \"exponential\"\ndirection = [0, 0, 0]"),
                HasSubstr("direction must have a length (x.toml:3"));
}

TEST(SceneFog, WhatCannotBeFilteredIsRefused) {
    EXPECT_THAT(sceneMessage("[fog]\nfilter_size = 3"), HasSubstr("filter_size must be 2, 4 or 6, got 3 (x.toml:2"));
    EXPECT_THAT(sceneMessage("[fog]\nnear = 5\nfar = 5"), HasSubstr("near and far are the same"));
    EXPECT_THAT(sceneMessage("[fog.media]\ng = 0.5"), HasSubstr("write [[fog.media]] with two brackets"));
    EXPECT_THAT(sceneMessage("[[fog.media]]\nvisibility = 0"), HasSubstr("visibility must be above 0"));
    EXPECT_THAT(sceneMessage("[[fog.media]]\ng = 1"), HasSubstr("g must be above -1, below 1"));
}

/// Hess, Koepke and Schult (1998), table 4; at 550 nm the extinction is that of the visibility.
TEST(SceneFog, AnAerosolGivesAlbedoAndColour) {
    const auto medium = [](const std::string& name, double visibility) {
        return parseScene("[[fog.media]]\nvisibility = " + std::to_string(visibility) + "\naerosol = \"" + name + "\"",
                          "x.toml")
            .fog.media.at(0);
    };
    const FogMedium urban = medium("urban", 5000.0);
    const glm::dvec3 extinction = urban.scattering + urban.absorption;
    EXPECT_EQ(urban.g, 0.689);
    EXPECT_NEAR(extinction.x, 3.912 / 5000.0 * std::pow(640.0 / 550.0, -1.43), 1e-12);
    EXPECT_NEAR(extinction.y, 3.912 / 5000.0 * std::pow(540.0 / 550.0, -1.43), 1e-12);
    EXPECT_NEAR(extinction.z, 3.912 / 5000.0 * std::pow(500.0 / 550.0, -1.43) * std::pow(0.88, -1.14), 1e-12);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(urban.scattering[c] / extinction[c], 0.817, 1e-12);
    // from runway fog to the clearest air
    for (const double visibility : {50.0, 550.0, 50e3}) {
        const FogMedium fog = medium("fog", visibility);
        EXPECT_EQ(fog.scattering, glm::dvec3(3.912 / visibility));
        EXPECT_EQ(fog.absorption, glm::dvec3(0.0));
        EXPECT_GT(medium("maritime", visibility).scattering.z, fog.scattering.z * 0.99);
    }
    EXPECT_THAT(sceneMessage("[[fog.media]]\naerosol = \"urban\""), HasSubstr("aerosol needs a visibility (x.toml:2"));
    EXPECT_THAT(sceneMessage("[[fog.media]]\nvisibility = 50\naerosol = \"smog\""), HasSubstr("\"urban\""));
    for (const char* key : {"scattering", "absorption", "g"}) {
        EXPECT_THAT(sceneMessage(std::string("[[fog.media]]\naerosol = \"urban\"\n") + key + " = 0.5"),
                    HasSubstr("exclude each other"));
    }
}

TEST(SceneFog, AnAlbedoSplitsTheExtinctionOfAVisibility) {
    const FogMedium medium =
        parseScene("[[fog.media]]\nvisibility = 3912\nalbedo = [0.25, 0.5, 1.0]", "x.toml").fog.media.at(0);
    for (int c = 0; c < 3; ++c) {
        const double albedo = 0.25 * std::exp2(c);
        EXPECT_DOUBLE_EQ(medium.scattering[c], 0.001 * albedo);
        EXPECT_DOUBLE_EQ(medium.absorption[c], 0.001 * (1.0 - albedo));
    }
    EXPECT_THAT(sceneMessage("[[fog.media]]\nalbedo = 0.5"), HasSubstr("albedo needs a visibility (x.toml:2"));
    for (const char* key : {"scattering = 0.1", "absorption = 0.1", "aerosol = \"urban\""})
        EXPECT_THAT(sceneMessage(std::string("[[fog.media]]\nalbedo = 0.5\n") + key), HasSubstr("exclude each other"));
}

TEST(SceneFog, AVisibilityIsFoundAgainInTheExtinction) {
    EXPECT_FALSE(visibilityOf(glm::dvec3(0.0)));
    EXPECT_DOUBLE_EQ(*visibilityOf(glm::dvec3(3.912)), 1.0);
    for (const std::string_view name : aerosolNames()) {
        const std::string text = "[[fog.media]]\nvisibility = 700\naerosol = \"" + std::string(name) + "\"";
        const FogMedium medium = parseScene(text, "x.toml").fog.media.at(0);
        EXPECT_NEAR(*visibilityOf(medium.scattering + medium.absorption), 700.0, 1e-9) << name;
    }
}

TEST(SceneFog, TheGroundEndsALayerFromBelow) {
    const std::string media = "[[fog.media]]\ntop = 500\n[[fog.media]]\nbottom = 200\ntop = 300\n";
    const auto bottoms = [&](const std::string& rest) {
        const Fog fog = parseScene(media + rest, "x.toml").fog;
        return std::pair(fog.media.at(0).bottom, fog.media.at(1).bottom);
    };
    constexpr double none = -std::numeric_limits<double>::infinity();
    EXPECT_EQ(bottoms(""), std::pair(none, 200.0));
    EXPECT_EQ(bottoms("[ground]\nheight = -50"), std::pair(-50.0, 200.0));
    EXPECT_EQ(bottoms("[ground]\nheight = 250"), std::pair(250.0, 250.0));
    EXPECT_EQ(bottoms("[ground]\nheight = 400"), std::pair(400.0, 300.0)) << "nothing is left of the second";
    EXPECT_EQ(bottoms("[sky]\nmodel = \"atmosphere\""), std::pair(0.0, 200.0)) << "the planet";
}

TEST(SceneFog, BottomAndTopAreOfLayersAndInOrder) {
    EXPECT_THAT(sceneMessage("[[fog.media]]\nbottom = 5\ntop = 5"),
                HasSubstr("bottom 5 is not below its top 5 (x.toml:2, fog.media.0.bottom): give a lower one"));
    EXPECT_THAT(sceneMessage("[[fog.media]]\nkind = \"sphere\"\ntop = 5"), HasSubstr("top has no effect"));
    EXPECT_THAT(sceneMessage("[[fog.media]]\nhalf_size = [1, 1, 1]"), HasSubstr("half_size has no effect"));
    EXPECT_THAT(sceneMessage("[[fog.media]]\nkind = \"box\"\nhalf_size = [1, 0, 1]"),
                HasSubstr("half_size must be above 0 (x.toml:3"));
}

/// `mend` is part of the message of the refusal, empty where the fog is fine.
void expectBound(const std::string& text, const std::string& mend, const std::string& sky) {
    const std::string toml = text + sky;
    try {
        requireBoundedFog(parseScene(toml, "x.toml"));
        EXPECT_EQ(mend, "") << toml;
    } catch (const InputError& e) {
        EXPECT_NE(mend, "") << toml << ": " << e.what();
        EXPECT_THAT(e.what(), HasSubstr(mend)) << toml;
    }
}

/// Under a constant sky, unless the scene has one.
void expectBound(const std::string& toml, const std::string& mend) {
    expectBound(toml, mend, toml.find("[sky]") == std::string::npos ? "\n[sky]\nmodel = \"constant\"\n" : "");
}

TEST(SceneFog, ThePlanetOfTheDefaultSkyEndsFog) {
    const std::string homogeneous = "[[fog.media]]\nvisibility = 100\n",
                      exponential = homogeneous + "kind = \"exponential\"\n";
    expectBound(homogeneous, "fog.media.0.top): give a height", "");
    expectBound(homogeneous + "top = 0", "", "");
    expectBound(exponential, "", "");
    expectBound(exponential + "direction = [0, -1, 0]", "fog.media.0.top", "");
}

TEST(SceneFog, EndlessFogInTheLightOfSunAndSkyIsRefused) {
    const std::string homogeneous = "[[fog.media]]\nvisibility = 100\n",
                      exponential = homogeneous + "kind = \"exponential\"\n", box = homogeneous + "kind = \"box\"\n";
    expectBound(homogeneous, "fog.media.0.top): give top and bottom");
    expectBound(homogeneous + "bottom = 0", "fog.media.0.top): give a height");
    expectBound(homogeneous + "top = 0", "fog.media.0.bottom): give a height in metres, or [ground] height");
    expectBound(homogeneous + "top = 50\n[ground]\nheight = 0", "");
    expectBound(homogeneous + "bottom = 0\ntop = 50", "");
    expectBound(exponential, "fog.media.0.bottom");
    expectBound(exponential + "bottom = 0", "");
    expectBound(exponential + "bottom = 0\nfalloff = 0", "fog.media.0.top");
    expectBound(exponential + "direction = [0, -1, 0]", "fog.media.0.top");
    expectBound(exponential + "direction = [0, -1, 0]\ntop = 0", "");
    expectBound(exponential + "direction = [0.1, 1, 0]\nbottom = 0", "fog.media.0.top");
    expectBound(exponential + "direction = [0.1, 1, 0]\nbottom = 0\ntop = 9", "");
    expectBound(box + homogeneous, "fog.media.1.top");
    expectBound(box, "");
    expectBound("[[fog.media]]\n", "");
    const std::string night = "[sun]\nirradiance = 0\n[sky]\nradiance = 0\n";
    expectBound(homogeneous + night, "");
    expectBound("[[fog.media]]\nemission = 1\n" + night, "fog.media.0.top");
}

}  // namespace
}  // namespace lumulus::scene
