#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "scene/load.h"
#include "support/scene_message.h"
#include "support/temporary_folder.h"

namespace lumulus::scene {
namespace {

using testing::AllOf;
using testing::HasSubstr;

using test::sceneMessage;

TEST(SceneMap, KeysAreReadAndTheSunIsOff) {
    const test::TemporaryFolder folder;
    std::ofstream(folder.path() / "sky.exr") << "picture";
    const std::string name = (folder.path() / "scene.toml").string();
    const Scene scene = parseScene(
        "[sky]\nmodel = \"map\"\nmap = \"sky.exr\"\nmap_scale = 2\nmap_rotation = -90\nmap_sun = false", name);
    EXPECT_EQ(scene.sky.model, SkyModel::map);
    EXPECT_EQ(scene.sky.map, folder.path() / "sky.exr");
    EXPECT_EQ(scene.sky.mapScale, 2.0);
    EXPECT_EQ(scene.sky.mapRotation, -90.0);
    EXPECT_FALSE(scene.sky.mapSun);
    EXPECT_EQ(scene.sun.irradiance, glm::dvec3(0.0));
    const std::vector<std::string> overrides{"sun.irradiance=3"};
    EXPECT_EQ(parseScene("[sky]\nmodel = \"map\"\nmap = \"sky.exr\"", name, overrides).sun.irradiance, glm::dvec3(3.0));
}

TEST(SceneMap, BadInputIsNamed) {
    EXPECT_THAT(sceneMessage("[sky]\nmodel = \"map\"\nmap = \"none.exr\""),
                AllOf(HasSubstr("none.exr does not exist"), HasSubstr("x.toml:3")));
    EXPECT_THAT(sceneMessage("[sky]\nmodel = \"map\"\nmap = \"/tmp\""), HasSubstr("is a folder"));
    EXPECT_THAT(sceneMessage("[sky]\nmap = \"none.exr\""), HasSubstr("sky.map has no effect"));
    EXPECT_THAT(sceneMessage("[sky]\nmap_scale = 2.0"), HasSubstr("sky.map_scale has no effect"));
    EXPECT_THAT(sceneMessage("[sky]\nmodel = \"map\"\nmap_scale = 0.0"), HasSubstr("map_scale"));
    EXPECT_THAT(sceneMessage("[sky]\nmodel = \"map\"\nmap_rotation = nan"), HasSubstr("map_rotation"));
}

/// A scene that comes from elsewhere reads no file outside of the folders that are given.
TEST(SceneMap, FoldersThatAreNotAllowedAreNotRead) {
    const test::TemporaryFolder folder, other;
    std::ofstream(folder.path() / "sky.exr") << "picture";
    const std::array allowed{other.path()};
    const std::string toml = "[sky]\nmodel = \"map\"\nmap = \"" + (folder.path() / "sky.exr").string() + "\"";
    EXPECT_NO_THROW(parseScene(toml, "x.toml"));
    EXPECT_THROW(parseScene(toml, "x.toml", {}, {}, allowed), InputError);
}

}  // namespace
}  // namespace lumulus::scene
