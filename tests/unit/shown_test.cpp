#include "draw/shown.h"

#include <gtest/gtest.h>

#include <random>

namespace lumulus::draw {
namespace {

using glm::dvec3;

Camera cameraFor(scene::Projection projection, const dvec3& position, const dvec3& target, double fov = 40.0) {
    scene::Camera camera;
    camera.position = position;
    camera.target = target;
    camera.projection = projection;
    camera.verticalFov = fov;
    return makeCamera(camera, {160, 96}, Bounds{});
}

const Tile whole{0, 0, 160, 96};

/// Turned and sheared.
Bounds slanted(const dvec3& centre) {
    Bounds bounds;
    bounds.centre = centre;
    bounds.halfAxes = glm::dmat3(dvec3(9.0, 2.0, 1.0), dvec3(-3.0, 7.0, 2.0), dvec3(1.0, -1.0, 5.0));
    return bounds;
}

/// Distance of the closest point of the ray from p.
double distanceTo(const Ray& ray, const dvec3& p) {
    const double along = glm::dot(p - ray.origin, ray.direction);
    return glm::distance(p, ray.origin + std::max(along, 0.0) * ray.direction);
}

bool holds(const Tile& tile, int x, int y) {
    return x >= tile.x && x < tile.x + tile.width && y >= tile.y && y < tile.y + tile.height;
}

/// Whatever the camera, a pixel outside meets none of sixty spheres within the bounds.
TEST(ShownPart, HoldsAllThatIsSeen) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const double reach = 1.5;
    int cut = 0;
    for (const auto projection : {scene::Projection::perspective, scene::Projection::orthographic}) {
        for (int i = 0; i < 20; ++i) {
            const Bounds cloud = slanted(20.0 * dvec3(uniform(random), uniform(random), uniform(random)));
            const Camera camera =
                cameraFor(projection, {0.0, 0.0, 60.0}, {0.0, 0.0, 0.0}, 50.0 + 30.0 * uniform(random));
            const Tile shown = shownPart(camera, cloud, reach, whole);
            cut += shown.width * shown.height < 160 * 96;
            std::vector<dvec3> places;
            for (int k = 0; k < 60; ++k)
                places.push_back(cloud.centre +
                                 cloud.halfAxes * dvec3(uniform(random), uniform(random), uniform(random)));
            for (int y = 0; y < 96; y += 2)
                for (int x = 0; x < 160; x += 3) {
                    if (holds(shown, x, y)) continue;
                    const Ray ray = camera.ray(x + 0.5, y + 0.5);
                    for (const dvec3& place : places) ASSERT_GT(distanceTo(ray, place), reach) << x << " " << y;
                }
        }
    }
    EXPECT_GT(cut, 30);
}

/// A cube of 20 m in the middle of a picture of 96 m by 160 m, a metre a pixel; whole tiles, one pixel to spare.
TEST(ShownPart, IsNoLargerThanItMustBe) {
    Camera camera = cameraFor(scene::Projection::orthographic, {0.0, 0.0, 60.0}, {0.0, 0.0, 0.0});
    camera.orthographicHeight = 96.0;
    Bounds cube;
    cube.halfAxes = glm::dmat3(10.0);
    EXPECT_EQ(shownPart(camera, cube, 0.0, whole), (Tile{64, 32, 32, 32}));
    EXPECT_EQ(shownPart(camera, cube, 6.0, whole), (Tile{56, 24, 48, 48}));
    EXPECT_EQ(shownPart(camera, cube, 0.0, {70, 10, 40, 30}), (Tile{70, 32, 26, 8})) << "within a tile";
    cube.outline = {dvec3(-10.0, 0.0, 0.0), dvec3(0.0, 0.0, 10.0)};
    EXPECT_EQ(shownPart(camera, cube, 0.0, whole), (Tile{64, 40, 24, 16})) << "by the outline";
}

TEST(ShownPart, NothingWhereTheCloudIsOutOfView) {
    const Camera camera = cameraFor(scene::Projection::perspective, {0.0, 0.0, 60.0}, {0.0, 0.0, 0.0});
    const Tile shown = shownPart(camera, slanted({0.0, 400.0, 0.0}), 1.0, whole);
    EXPECT_EQ(shown.width * shown.height, 0);
    const Tile behind = shownPart(camera, slanted({0.0, 0.0, 90.0}), 1.0, whole);
    EXPECT_EQ(behind.width * behind.height, 0);
}

TEST(ShownPart, EverythingInsideAndInPanoramas) {
    for (const auto projection : {scene::Projection::perspective, scene::Projection::panorama}) {
        const Camera inside = cameraFor(projection, {0.0, 1.0, 0.0}, {0.0, 0.0, -20.0});
        EXPECT_EQ(shownPart(inside, slanted({0.0, 0.0, 0.0}), 1.0, whole), whole);
    }
    const Camera round = cameraFor(scene::Projection::panorama, {0.0, 0.0, 60.0}, {0.0, 0.0, 0.0});
    EXPECT_EQ(shownPart(round, slanted({0.0, 0.0, 0.0}), 1.0, whole), whole);
}

}  // namespace
}  // namespace lumulus::draw
