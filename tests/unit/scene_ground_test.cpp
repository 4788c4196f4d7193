#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "scene/load.h"
#include "support/scene_message.h"

namespace lumulus::scene {
namespace {

using testing::HasSubstr;

using test::sceneMessage;

TEST(SceneGround, AnyKeyOfTheSectionMakesOne) {
    EXPECT_FALSE(parseScene("", "x.toml").ground);
    EXPECT_EQ(parseScene("[ground]\nheight = -25.5", "x.toml").ground, (Ground{glm::dvec3(0.2), -25.5}));
    EXPECT_EQ(parseScene("[ground]\nalbedo = [0.1, 0.2, 0.3]", "x.toml").ground,
              (Ground{glm::dvec3(0.1, 0.2, 0.3), 0.0}));
    const std::vector<std::string> overrides{"ground.albedo=0.6"};
    EXPECT_EQ(parseScene("[ground]\nheight = 3", "x.toml", overrides).ground, (Ground{glm::dvec3(0.6), 3.0}));
}

TEST(SceneGround, BadInputIsNamed) {
    EXPECT_THAT(sceneMessage("[ground]\nalbedo = 1.5"), HasSubstr("albedo"));
    EXPECT_THAT(sceneMessage("[ground]\nalbedo = [0.1, -0.2, 0.3]"), HasSubstr("albedo"));
    EXPECT_THAT(sceneMessage("[ground]\nheight = nan"), HasSubstr("height"));
    EXPECT_THAT(sceneMessage("[ground]\ncolour = 0.5"), HasSubstr("colour"));
}

}  // namespace
}  // namespace lumulus::scene
