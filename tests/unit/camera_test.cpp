#include "view/camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "base/error.h"
#include "view/view.h"

namespace lumulus {
namespace {

using glm::dvec3;

MATCHER_P2(IsNear, expected, tolerance, "") {
    return glm::distance(arg, expected) <= tolerance;
}

scene::Camera lookingAlongMinusZ() {
    scene::Camera camera;
    camera.position = dvec3(1.0, 2.0, 3.0);
    camera.target = dvec3(1.0, 2.0, -7.0);
    camera.verticalFov = 90.0;
    return camera;
}

TEST(Camera, PerspectiveRaysAreThoseOfAPinhole) {
    const Camera camera = makeCamera(lookingAlongMinusZ(), {200, 100, 0.0}, {});
    EXPECT_THAT(camera.ray(100.0, 50.0).direction, IsNear(dvec3(0, 0, -1), 1e-15));
    EXPECT_THAT(camera.ray(100.0, 50.0).origin, IsNear(dvec3(1, 2, 3), 0.0));
    EXPECT_THAT(camera.ray(100.0, 0.0).direction, IsNear(dvec3(0, 1, -1) / std::sqrt(2.0), 1e-15));
    EXPECT_THAT(camera.ray(200.0, 50.0).direction, IsNear(dvec3(2, 0, -1) / std::sqrt(5.0), 1e-15));
    EXPECT_THAT(camera.ray(0.0, 100.0).direction, IsNear(dvec3(-2, -1, -1) / std::sqrt(6.0), 1e-15));
}

/// A window sees what the picture sees through the same pixels, also beyond the picture (overscan).
TEST(Camera, WindowsHaveTheRaysOfThePicture) {
    for (const auto projection : {scene::Projection::perspective, scene::Projection::orthographic}) {
        scene::Camera settings = lookingAlongMinusZ();
        settings.projection = projection;
        const Camera whole = makeCamera(settings, {160, 90, 0.0}, {});
        for (const Tile& window : {Tile{40, 20, 80, 45}, Tile{-10, -6, 180, 100}, Tile{159, 0, 1, 90}}) {
            const Camera part = windowCamera(whole, window);
            EXPECT_EQ(part.width, window.width);
            for (const double px : {0.5, 0.25 * window.width, window.width - 0.5})
                for (const double py : {0.5, 0.75 * window.height}) {
                    const Ray expected = whole.ray(window.x + px, window.y + py), found = part.ray(px, py);
                    EXPECT_THAT(found.direction, IsNear(expected.direction, 1e-14));
                    EXPECT_THAT(found.origin, IsNear(expected.origin, 1e-12));
                }
        }
    }
    scene::Camera settings = lookingAlongMinusZ();
    settings.projection = scene::Projection::panorama;
    const Camera sphere = makeCamera(settings, {160, 80, 0.0}, {});
    EXPECT_EQ(windowCamera(sphere, {0, 0, 160, 80}).width, 160);
    EXPECT_THROW(windowCamera(sphere, {0, 0, 80, 80}), InputError);
}

TEST(Camera, OrthographicRaysAreParallelAndFrameTheTarget) {
    scene::Camera settings = lookingAlongMinusZ();
    settings.projection = scene::Projection::orthographic;
    const Camera camera = makeCamera(settings, {200, 100, 0.0}, {});
    // 90° at ten metres: twenty metres from edge to edge
    EXPECT_NEAR(camera.orthographicHeight, 20.0, 1e-12);
    EXPECT_THAT(camera.ray(200.0, 0.0).origin, IsNear(dvec3(21, 12, 3), 1e-12));
    EXPECT_THAT(camera.ray(200.0, 0.0).direction, IsNear(dvec3(0, 0, -1), 1e-15));
}

TEST(Camera, PanoramaCoversTheSphere) {
    scene::Camera settings = lookingAlongMinusZ();
    settings.projection = scene::Projection::panorama;
    settings.target = dvec3(1.0, 5.0, -7.0);  // above the horizon: the panorama stays level
    const Camera camera = makeCamera(settings, {360, 180, 0.0}, {});
    EXPECT_THAT(camera.ray(180.0, 90.0).direction, IsNear(dvec3(0, 0, -1), 1e-14));
    EXPECT_THAT(camera.ray(270.0, 90.0).direction, IsNear(dvec3(1, 0, 0), 1e-14));
    EXPECT_THAT(camera.ray(0.0, 90.0).direction, IsNear(dvec3(0, 0, 1), 1e-14));
    EXPECT_THAT(camera.ray(123.0, 0.0).direction, IsNear(dvec3(0, 1, 0), 1e-14));
    EXPECT_THAT(camera.ray(180.0, 135.0).direction, IsNear(dvec3(0, -1, -1) / std::sqrt(2.0), 1e-14));
}

TEST(Camera, LooksStraightDownWithNorthAtTheTop) {
    scene::Camera settings = lookingAlongMinusZ();
    settings.target = dvec3(1.0, -50.0, 3.0);
    const Camera camera = makeCamera(settings, {100, 100, 0.0}, {});
    EXPECT_THAT(camera.axes[1], IsNear(dvec3(0, 0, -1), 1e-15));
    EXPECT_THAT(camera.axes[0], IsNear(dvec3(1, 0, 0), 1e-15));

    settings.projection = scene::Projection::panorama;
    const Camera panorama = makeCamera(settings, {100, 50, 0.0}, {});
    EXPECT_THAT(panorama.ray(50.0, 25.0).direction, IsNear(dvec3(0, 0, -1), 1e-14));
    EXPECT_THAT(panorama.ray(50.0, 50.0).direction, IsNear(dvec3(0, -1, 0), 1e-14));
}

/// Where a point falls in the picture of a perspective camera, −1…1 on both axes, by plain trigonometry.
glm::dvec2 project(const Camera& camera, const dvec3& point, double fov) {
    const dvec3 forward = camera.ray(0.5 * camera.width, 0.5 * camera.height).direction;
    const dvec3 right = glm::normalize(glm::cross(forward, dvec3(0, 1, 0)));
    const dvec3 p = point - camera.position;
    const double tanY = std::tan(glm::radians(fov) / 2.0);
    const double depth = glm::dot(p, forward);
    return {glm::dot(p, right) / (depth * tanY * camera.width / camera.height),
            glm::dot(p, glm::cross(right, forward)) / (depth * tanY)};
}

TEST(Camera, FramesACloudThatNobodyPointedAt) {
    Bounds cloud;
    cloud.centre = dvec3(1e7, 300.0, -2e6);
    cloud.halfAxes = glm::dmat3(400, 0, 0, 0, 250, 0, 0, 0, 500);
    for (const scene::Image& image : {scene::Image{1280, 720, 0.0}, scene::Image{300, 500, 0.0}}) {
        const Camera camera = makeCamera({}, image, cloud);
        double reach = 0.0;
        for (const dvec3& corner : cloud.corners()) {
            const glm::dvec2 p = glm::abs(project(camera, corner, 40.0));
            reach = std::max({reach, p.x, p.y});
        }
        EXPECT_NEAR(reach, 0.9, 1e-6);
        const dvec3 away = camera.position - cloud.centre;
        EXPECT_NEAR(std::atan2(away.x, away.z), glm::radians(20.0), 1e-9);
        EXPECT_NEAR(away.y / glm::length(away), -std::sin(glm::radians(5.0)), 1e-9);
    }
}

TEST(Camera, FramesTheOutlineWhereThereIsOne) {
    Bounds cloud;
    cloud.halfAxes = glm::dmat3(10.0);
    cloud.outline = {dvec3(0, 1, 0), dvec3(0, -1, 0)};
    const Camera camera = makeCamera({}, {100, 100, 0.0}, cloud);
    EXPECT_NEAR(std::max(project(camera, cloud.outline[0], 40.0).y, -project(camera, cloud.outline[1], 40.0).y), 0.9,
                1e-9);
}

TEST(Camera, TurnsFromAGivenPositionToTheCloud) {
    Bounds cloud;
    cloud.centre = dvec3(10.0, 0.0, 0.0);
    scene::Camera settings;
    settings.position = dvec3(-20.0, 0.0, 0.0);
    EXPECT_THAT(makeCamera(settings, {64, 64, 0.0}, cloud).axes[2], IsNear(dvec3(1, 0, 0), 1e-15));
    settings.target = settings.position;
    EXPECT_THROW(makeCamera(settings, {64, 64, 0.0}, cloud), InputError);
}

TEST(Bounds, AreThoseOfTheFilledVoxels) {
    vdb::Volume volume;
    volume.size = {6, 5, 4};
    volume.density.assign(6 * 5 * 4, 0.0F);
    volume.toWorld.linear = glm::dmat3(0, 2, 0, 3, 0, 0, 1, 0, 4);  // turned and sheared
    volume.toWorld.translation = dvec3(100.0, 0.0, 0.0);
    const Bounds all = boundsOf(volume);
    EXPECT_THAT(all.centre, IsNear(volume.toWorld.point(dvec3(3, 2.5, 2)), 1e-12));

    volume.density[volume.index(2, 1, 1)] = 0.5F;
    volume.density[volume.index(3, 3, 1)] = 0.5F;
    const Bounds some = boundsOf(volume);
    EXPECT_THAT(some.centre, IsNear(volume.toWorld.point(dvec3(3, 2.5, 1.5)), 1e-12));
    EXPECT_THAT(some.halfAxes[0], IsNear(dvec3(0, 2, 0), 1e-12));
    EXPECT_THAT(some.halfAxes[1], IsNear(dvec3(4.5, 0, 0), 1e-12));
    EXPECT_THAT(some.halfAxes[2], IsNear(dvec3(0.5, 0, 2), 1e-12));
    EXPECT_EQ(some.outline.size(), 8U);  // both voxels lie in one bundle of rows
    for (const dvec3& point : some.outline) {
        const dvec3 inBox = glm::inverse(some.halfAxes) * (point - some.centre);
        EXPECT_THAT(glm::abs(inBox), IsNear(dvec3(1.0), 1e-12));
    }
    double farthest = 0.0;
    for (const dvec3& corner : some.corners()) farthest = std::max(farthest, glm::distance(corner, some.centre));
    EXPECT_DOUBLE_EQ(some.radius(), farthest);
}

TEST(Bounds, UniteToABoxAlongTheAxes) {
    Bounds one;
    one.centre = dvec3(1.0, 2.0, 3.0);
    one.halfAxes = glm::dmat3(0, 2, 0, 3, 0, 0, 1, 0, 4);
    one.outline = {dvec3(1.0), dvec3(2.0)};
    const Bounds same = unite(std::array{one});
    EXPECT_EQ(same.centre, one.centre);
    EXPECT_EQ(same.halfAxes, one.halfAxes);
    EXPECT_EQ(same.outline, one.outline);
    Bounds other;
    other.centre = dvec3(100.0, 0.0, 0.0);
    other.halfAxes = glm::dmat3(10.0);
    const Bounds both = unite(std::array{one, other});
    // the first reaches over 4, 2 and 4 m to each side of its middle
    EXPECT_THAT(both.centre, IsNear(0.5 * (dvec3(-3, -10, -10) + dvec3(110, 10, 10)), 1e-12));
    EXPECT_THAT(both.halfAxes[0], IsNear(dvec3(56.5, 0, 0), 1e-12));
    EXPECT_THAT(both.halfAxes[1], IsNear(dvec3(0, 10, 0), 1e-12));
    EXPECT_THAT(both.halfAxes[2], IsNear(dvec3(0, 0, 10), 1e-12));
    EXPECT_EQ(both.outline.size(), 2U + 8U) << "the corners of what has no outline";
    EXPECT_EQ(unite({}).halfAxes, Bounds{}.halfAxes);
}

/// In every direction the outline reaches as far as the cloud, and no farther than the bundles of four by four rows
/// that it is made of; points that others hold between them are left out.
TEST(Bounds, OutlineIsAConvexHull) {
    constexpr int size = 48;
    vdb::Volume volume;
    volume.size = {size, size, size};
    volume.density.assign(size * size * size, 0.0F);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    std::vector<dvec3> corners;
    for (int z = 0; z < size; ++z)
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) {
                // a ball with a rough surface
                const double away = glm::distance(dvec3(x, y, z) + 0.5, dvec3(0.5 * size));
                if (away > 18.0 + 4.0 * uniform(random)) continue;
                volume.density[volume.index(x, y, z)] = 1.0F;
                for (unsigned i = 0; i < 8; ++i) corners.emplace_back(x + (i & 1U), y + (i >> 1U & 1U), z + (i >> 2U));
            }
    const Bounds bounds = boundsOf(volume);
    const auto reach = [](const std::vector<dvec3>& points, const dvec3& direction) {
        double farthest = -1e300;
        for (const dvec3& point : points) farthest = std::max(farthest, glm::dot(point, direction));
        return farthest;
    };
    for (int i = 0; i < 100; ++i) {
        const dvec3 direction = glm::normalize(dvec3(uniform(random), uniform(random), uniform(random)));
        const double found = reach(bounds.outline, direction), least = reach(corners, direction);
        ASSERT_GE(found, least - 1e-9);
        ASSERT_LE(found, least + 4.0 * std::sqrt(2.0));
    }
    EXPECT_LT(bounds.outline.size(), 400U) << "of 8 for each of some 120 bundles";
}

}  // namespace
}  // namespace lumulus
