#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/error.h"
#include "environment/levels.h"

namespace lumulus::environment {
namespace {

std::string refusal(Method method, int size, int count, const std::vector<double>& roughness = {}) {
    try {
        levelsOf(method, size, count, roughness);
    } catch (const InputError& e) {
        return e.what();
    }
    return {};
}

TEST(EnvironmentLevels, EqualSteps) {
    const std::vector<Level> levels = levelsOf(Method::sampling, 256, 5, {});
    ASSERT_EQ(levels.size(), 5U);
    for (std::size_t i = 0; i < 5; ++i) {
        EXPECT_DOUBLE_EQ(levels[i].roughness, 0.25 * static_cast<double>(i));
        EXPECT_EQ(levels[i].size, 256 >> i);
    }
    EXPECT_EQ(levelsOf(Method::sampling, 1, 1, {}).front().roughness, 0.0);
    EXPECT_EQ(defaultLevels(256), 5);
    EXPECT_EQ(defaultLevels(16), 1);
    EXPECT_EQ(defaultLevels(1), 1);
}

TEST(EnvironmentLevels, TheThesisHasEleven) {
    const std::vector<Level> levels = levelsOf(Method::thesis, 1024, 3, {});
    ASSERT_EQ(levels.size(), 11U);
    EXPECT_EQ(levels.back().size, 1);
    EXPECT_EQ(levels[4].roughness, 0.2);
    EXPECT_THAT(refusal(Method::thesis, 512, 3), testing::HasSubstr("(--size)"));
}

TEST(EnvironmentLevels, Refusals) {
    EXPECT_THAT(refusal(Method::sampling, 256, 0), testing::HasSubstr("(--levels): give 1 to 9"));
    EXPECT_THAT(refusal(Method::sampling, 256, 10), testing::HasSubstr("10 levels do not fit"));
    EXPECT_EQ(refusal(Method::sampling, 256, 9), "");
    EXPECT_THAT(refusal(Method::sampling, 2, 5, {0.0, 0.5, 1.0}), testing::HasSubstr("(--roughness)"));
    EXPECT_THAT(refusal(Method::sampling, 256, 5, {0.0, 0.0}), testing::HasSubstr("rising"));
}

/// A level of the thesis through the filter: white stays white, at every size.
TEST(EnvironmentLevels, FilterOfTheThesis) {
    const prefilter::Panorama white{8, 4, std::vector<glm::vec3>(32, glm::vec3(3.0F))};
    const LevelFilter filter(Method::thesis, white, 16, [] {});
    const std::vector<glm::vec3> directions{{0.0F, 1.0F, 0.0F}, {0.6F, 0.0F, 0.8F}};
    for (const Level& level : levelsOf(Method::thesis, 1024, 11, {}))
        for (const glm::vec3& value : filter.filtered(level, directions)) EXPECT_NEAR(value.g, 3.0F, 1e-5F);
}

}  // namespace
}  // namespace lumulus::environment
