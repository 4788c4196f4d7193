#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/error.h"
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

}  // namespace
}  // namespace lumulus::scene
