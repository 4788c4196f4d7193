#include "service/render/media_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

namespace lumulus::service {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

MediumEdit edit(std::uint32_t medium, std::map<std::string, std::string> keys, bool original = false) {
    return {medium, original, std::move(keys)};
}

std::vector<std::string> changed(const MediaKeys& keys, const std::vector<MediumEdit>& edits) {
    return overridesOf(changedKeys(keys, edits));
}

TEST(MediaSource, NewerKeysTakeThePlaceOfThoseThatTheyExclude) {
    const MediaKeys keys{{"fog.media.0.albedo", "0.9"}, {"fog.media.0.visibility", "500"}, {"fog.media.1.g", "0.1"}};
    EXPECT_THAT(changed(keys, {edit(0, {{"visibility", "70"}})}),
                ElementsAre("fog.media.0.albedo=0.9", "fog.media.0.visibility=70", "fog.media.1.g=0.1"));
    EXPECT_THAT(changed(keys, {edit(0, {{"scattering", "0.1"}}), edit(1, {{"top", "9"}})}),
                ElementsAre("fog.media.0.scattering=0.1", "fog.media.1.g=0.1", "fog.media.1.top=9"));
    EXPECT_THAT(changed(keys, {edit(0, {{"g", "0.5"}}, true)}), ElementsAre("fog.media.0.g=0.5", "fog.media.1.g=0.1"));
    EXPECT_THAT(changed({{"fog.media.1.g", "0"}, {"fog.media.12.g", "0"}}, {edit(1, {}, true)}),
                ElementsAre("fog.media.12.g=0"));
    // of one change both stay, and the scene's checks refuse them
    EXPECT_THAT(changed({}, {edit(0, {{"scattering", "0.1"}, {"visibility", "9"}})}),
                ElementsAre("fog.media.0.scattering=0.1", "fog.media.0.visibility=9"));
}

TEST(MediaSource, MediaAreThoseOfTheSceneWithTheKeys) {
    LoadScene load;
    load.toml = "[[cloud]]\nvdb = \"gone.vdb\"\n[[fog.media]]\nscattering = 0.1\ntop = 100\nbottom = 20\n";
    load.overrides = {"fog.media.0.top=90"};
    const RenderConfig config;
    const std::vector<scene::FogMedium> media =
        mediaWith(load, config, {{"fog.media.0.visibility", "3.912"}, {"fog.media.0.g", "0.5"}}, true);
    ASSERT_EQ(media.size(), 1U);
    EXPECT_EQ(media[0].scattering, glm::dvec3(1.0));
    EXPECT_EQ((std::array{media[0].top, media[0].bottom, media[0].g}), (std::array{90.0, 20.0, 0.5}));
}

TEST(MediaSource, WhatIsWrongIsSaidOfTheField) {
    LoadScene load;
    load.toml = "[[fog.media]]\ntop = 100\n[[fog.media]]\nkind = \"exponential\"\n";
    const auto refusal = [&](const std::vector<MediumEdit>& edits, bool lit) -> Failure {
        try {
            mediaWith(load, {}, changedKeys({}, edits), lit);
        } catch (const InputError& e) {
            return failureOf(e, edits);
        }
        return {};
    };
    Failure failure = refusal({edit(0, {{"g", "0"}}), edit(1, {{"visibility", "-1"}})}, true);
    EXPECT_EQ(failure.where, "media[1].visibility");
    EXPECT_THAT(failure.text, HasSubstr("visibility must be above 0"));
    EXPECT_THAT(failure.text, HasSubstr("(fog.media.1.visibility)"));
    failure = refusal({edit(1, {{"falloff", "0"}, {"scattering", "0.1"}})}, true);
    EXPECT_EQ(failure.where, "media[0].top");
    EXPECT_THAT(failure.text, HasSubstr("needs a top"));
    EXPECT_EQ(refusal({edit(1, {{"falloff", "0"}, {"scattering", "0.1"}})}, false).text, "");
}

}  // namespace
}  // namespace lumulus::service
