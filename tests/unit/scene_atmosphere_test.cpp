// Keys of the atmosphere: presets, what the model implies, and what it refuses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "scene/load.h"
#include "scene/sunlight.h"

namespace lumulus::scene {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

Scene parsed(const std::string& toml) {
    return parseScene(toml, "test.toml");
}

TEST(SceneAtmosphere, PresetsSetTheAirAndKeysChangeIt) {
    const Sky hazy = parsed("[sky]\nmodel = \"atmosphere\"\npreset = \"hazy\"").sky;
    EXPECT_EQ(hazy.model, SkyModel::atmosphere);
    EXPECT_EQ(hazy.aerosolDepth, 0.3);
    const Sky changed =
        parsed("[sky]\nmodel = \"atmosphere\"\naerosol_depth = 0.2\npreset = \"hazy\"\nozone = 250").sky;
    EXPECT_EQ(changed.aerosolDepth, 0.2);
    EXPECT_EQ(changed.ozone, 250.0);
    EXPECT_TRUE(parsed("[sky]\nmodel = \"atmosphere\"\npreset = \"hillaire\"").sky.hillaire);
    EXPECT_EQ(parsed("[sky]\nmodel = \"atmosphere\"").sky.aerosolDepth, 0.084);
}

TEST(SceneAtmosphere, TheSunIsThatAboveTheAirUnlessGiven) {
    EXPECT_EQ(parsed("[sky]\nmodel = \"atmosphere\"").sun.irradiance, sunAboveAir);
    EXPECT_TRUE(parsed("[sky]\nmodel = \"atmosphere\"").sun.limbDarkening);
    EXPECT_EQ(parsed("[sky]\nmodel = \"atmosphere\"\n[sun]\nirradiance = 3").sun.irradiance, glm::dvec3(3.0));
    EXPECT_EQ(parsed("[sky]\nmodel = \"constant\"").sun, Sun{});
}

TEST(SceneAtmosphere, RefusesWhatItDoesNotRead) {
    const auto refuses = [](const std::string& toml, const char* what) {
        EXPECT_THAT([&] { parsed(toml); }, ThrowsMessage<InputError>(HasSubstr(what))) << toml;
    };
    refuses("[sky]\nmodel = \"atmosphere\"\nradiance = 1", "sky.radiance has no effect (test.toml:3");
    refuses("[sky]\nmodel = \"constant\"\naerosol_depth = 0.1", "sky.aerosol_depth has no effect (test.toml:3");
    refuses("[sky]\nmodel = \"atmosphere\"\npreset = \"hillaire\"\nozone = 3", "sky.ozone has no effect");
    refuses("[sky]\nmodel = \"atmosphere\"\naerosol_depth = -0.1", "test.toml:3, sky.aerosol_depth");
    refuses("[sky]\nmodel = \"atmosphere\"\nground_albedo = 1.1", "test.toml:3, sky.ground_albedo");
    refuses("[sky]\nmodel = \"atmosphere\"\nozone = nan", "test.toml:3, sky.ozone");
    refuses("[sky]\nmodel = \"atmosphere\"\npreset = \"foggy\"", "test.toml:3, sky.preset");
    // of the file's keys those that the model of the command line leaves out do not count
    const std::vector<std::string> overrides{"sky.model=\"constant\""};
    EXPECT_EQ(parseScene("[sky]\nmodel = \"atmosphere\"\nozone = 3", "test.toml", overrides).sky.model,
              SkyModel::constant);
}

}  // namespace
TEST(SceneAtmosphere, IsExposedByItsPictureUnlessAnExposureIsGiven) {
    const auto modeOf = [](const std::string& text) { return parseScene(text, "a.toml", {}).image.exposureMode; };
    EXPECT_EQ(modeOf("[sky]\nmodel = \"constant\"\n"), ExposureMode::stops);
    EXPECT_EQ(modeOf(""), ExposureMode::automatic);
    EXPECT_EQ(modeOf("[sky]\nmodel = \"atmosphere\"\n"), ExposureMode::automatic);
    EXPECT_EQ(modeOf("[image]\nexposure = -6.0\n[sky]\nmodel = \"atmosphere\"\n"), ExposureMode::stops);
    EXPECT_EQ(modeOf("[image]\nexposure_mode = \"ev100\"\n[sky]\nmodel = \"atmosphere\"\n"), ExposureMode::ev100);
}

}  // namespace lumulus::scene
