#include <gtest/gtest.h>

#include <cmath>

#include "view/ground.h"

namespace lumulus {
namespace {

scene::Scene unnamedSky() {
    scene::Scene scene;
    scene.sky.model = scene::SkyModel::atmosphere;
    scene.sky.groundBelowClouds = true;
    scene.camera.position = glm::dvec3(0.0, 900.0, 2000.0);
    return scene;
}

Bounds boxOf(const glm::dvec3& centre, double half) {
    Bounds bounds;
    bounds.centre = centre;
    bounds.halfAxes = glm::dmat3(half);
    return bounds;
}

TEST(GroundBelowClouds, IsAtZeroWhereCloudsAreHighAboveIt) {
    const auto ground = groundedScene(unnamedSky(), boxOf({0.0, 1500.0, 0.0}, 100.0)).ground;
    ASSERT_TRUE(ground);
    EXPECT_EQ(ground->height, 0.0);
    EXPECT_EQ(ground->foot, glm::dvec2(0.0));
    EXPECT_EQ(ground->albedo, unnamedSky().sky.groundAlbedo);
}

TEST(GroundBelowClouds, KeepsItsDistanceFromCloudsAndCamera) {
    // three radii of a box of 2 · 300 m, √3 · 300 m, are more than the least distance, below a base at −300 m
    EXPECT_NEAR(groundedScene(unnamedSky(), boxOf(glm::dvec3(0.0), 300.0)).ground->height,
                -300.0 - 3.0 * std::sqrt(3.0) * 300.0, 1e-9);
    EXPECT_NEAR(groundedScene(unnamedSky(), boxOf({0.0, 100.0, 0.0}, 10.0)).ground->height, 90.0 - 600.0, 1e-9);
    EXPECT_NEAR(groundedScene(unnamedSky(), boxOf(glm::dvec3(0.0), 9000.0)).ground->height, -9000.0 - 2000.0, 1e-9);
    scene::Scene low = unnamedSky();
    low.camera.position = glm::dvec3(0.0, -5000.0, 0.0);
    EXPECT_NEAR(groundedScene(low, boxOf({0.0, 100.0, 0.0}, 10.0)).ground->height, -5600.0, 1e-9);
}

/// Coordinates of a map, or of a simulation that counts from elsewhere, do not put clouds into space.
TEST(GroundBelowClouds, FollowsCloudsThatAreFarFromTheOrigin) {
    scene::Scene far = unnamedSky();
    far.camera.position = glm::dvec3(5e5, 1e7, 4.6e6);
    const auto ground = groundedScene(far, boxOf({5e5, 1e7, 4.6e6 + 900.0}, 100.0)).ground;
    EXPECT_NEAR(ground->height, 1e7 - 100.0 - 600.0, 1e-6);
    EXPECT_EQ(ground->foot, glm::dvec2(5e5, 4.6e6 + 900.0));
}

TEST(GroundBelowClouds, OtherScenesStayAsTheyAre) {
    scene::Scene named = unnamedSky();
    named.sky.groundBelowClouds = false;
    EXPECT_FALSE(groundedScene(named, boxOf(glm::dvec3(0.0), 300.0)).ground);
}

TEST(GroundBelowClouds, EndsFog) {
    scene::Scene scene = unnamedSky();
    scene.fog.media.resize(2);
    scene.fog.media[0].top = 0.0;
    scene.fog.media[1].kind = scene::MediumKind::sphere;
    const scene::Scene grounded = groundedScene(scene, boxOf({0.0, 100.0, 0.0}, 10.0));
    EXPECT_EQ(grounded.fog.media[0].bottom, grounded.ground->height);
    EXPECT_EQ(grounded.fog.media[1], scene.fog.media[1]);
}

}  // namespace
}  // namespace lumulus
