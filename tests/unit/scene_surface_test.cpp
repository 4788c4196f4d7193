#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/error.h"
#include "scene/load.h"
#include "support/scene_message.h"

namespace lumulus::scene {
namespace {

using testing::HasSubstr;

using test::sceneMessage;

TEST(SceneSurface, AllKeysAreRead) {
    const std::vector<Surface> surfaces = parseScene(R"(
[[surface]]
normal = [0, 3, 4]
albedo = [0.1, 0.2, 0.3]
[[surface]]
kind = "sphere"
position = [1, 2, 3]
radius = 4
emission = 1e4
[[surface]]
kind = "disc"
radius = 5
normal = [0, 0, -1]
)",
                                                     "x.toml")
                                              .surfaces;
    ASSERT_EQ(surfaces.size(), 3U);
    EXPECT_EQ(surfaces[0].kind, SurfaceKind::plane);
    EXPECT_EQ(surfaces[0].normal, glm::dvec3(0.0, 0.6, 0.8));
    EXPECT_EQ(surfaces[0].albedo, glm::dvec3(0.1, 0.2, 0.3));
    EXPECT_EQ(surfaces[1].kind, SurfaceKind::sphere);
    EXPECT_EQ(surfaces[1].position, glm::dvec3(1.0, 2.0, 3.0));
    EXPECT_EQ(surfaces[1].radius, 4.0);
    EXPECT_EQ(surfaces[1].emission, glm::dvec3(1e4));
    EXPECT_EQ(surfaces[1].albedo, glm::dvec3(0.5)) << "the default";
    EXPECT_EQ(surfaces[2].kind, SurfaceKind::disc);
    EXPECT_TRUE(parseScene("", "x.toml").surfaces.empty());
}

TEST(SceneSurface, OverridesReachOne) {
    const std::vector<std::string> overrides{"surface.0.albedo=0.25", "surface.1.kind=sphere",
                                             "fog.inscattering=false"};
    const Scene scene = parseScene("[[surface]]", "x.toml", overrides);
    ASSERT_EQ(scene.surfaces.size(), 2U);
    EXPECT_EQ(scene.surfaces[0].albedo, glm::dvec3(0.25));
    EXPECT_EQ(scene.surfaces[1].kind, SurfaceKind::sphere);
    EXPECT_FALSE(scene.fog.inscattering);
    EXPECT_TRUE(parseScene("", "x.toml").fog.inscattering);
}

TEST(SceneSurface, BadInputIsNamed) {
    EXPECT_THAT(sceneMessage("[[surface]]\nradius = 1"), HasSubstr("radius has no effect"));
    EXPECT_THAT(sceneMessage("[[surface]]\nkind = \"sphere\"\nnormal = [0, 1, 0]"), HasSubstr("normal has no effect"));
    EXPECT_EQ(sceneMessage("[[surface]]\nradius = 1\nkind = \"disc\"", {"surface.0.kind=plane"}), "no error");
    EXPECT_THAT(sceneMessage("[[surface]]\nnormal = [0, 0, 0]"), HasSubstr("normal must have a length (x.toml:2"));
    EXPECT_THAT(sceneMessage("[[surface]]\nalbedo = 1.1"), HasSubstr("x.toml:2, surface.0.albedo"));
    EXPECT_THAT(sceneMessage("[[surface]]\nkind = \"box\""), HasSubstr("surface.0.kind"));
    EXPECT_THAT(sceneMessage("[surface]\nalbedo = 1"), HasSubstr("[[surface]]"));
    EXPECT_THAT(sceneMessage("", {"surface.albedo=1"}), HasSubstr("write surface.0.albedo"));
    EXPECT_THAT(sceneMessage("[fog]\ninscattering = 1"),
                HasSubstr("inscattering must be true or false, got an integer"));
    EXPECT_THAT(sceneMessage("[fog]\ninscattering = \"no\""), HasSubstr("true or false"));
}

}  // namespace
}  // namespace lumulus::scene
