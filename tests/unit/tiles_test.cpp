#include "draw/tiles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "view/bounds.h"

namespace lumulus::draw {
namespace {

using glm::dvec3;
using shared::Billboard;

struct View {
    scene::Projection projection;
    int width, height;
    double fov;
};

Camera cameraFor(const View& view) {
    scene::Camera camera;
    camera.position = dvec3(5.0, -3.0, 8.0);
    camera.target = dvec3(4.0, 30.0, -60.0);
    camera.projection = view.projection;
    camera.verticalFov = view.fov;
    return makeCamera(camera, {view.width, view.height}, Bounds{});
}

/// Spheres all around the eye, of sizes that cover less than a pixel up to all of the view; the eye is inside some.
std::vector<Billboard> randomSpheres(std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(0.0F, 1.0F);
    std::normal_distribution<float> normal;
    std::vector<Billboard> spheres;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3 direction = glm::normalize(glm::vec3(normal(random), normal(random), normal(random)));
        const float distance = 100.0F * std::pow(uniform(random), 1.5F);
        spheres.push_back({distance * direction, 30.0F * std::pow(uniform(random), 4.0F) + 0.05F, 1.0F, 0.0F});
    }
    return spheres;
}

/// Whether the ray meets the sphere in front of its origin, with its chord at least 1e-3 of the radius long.
bool meets(const Ray& ray, const dvec3& eye, const Billboard& sphere) {
    const dvec3 centre = dvec3(sphere.centre) - (ray.origin - eye);
    const double along = glm::dot(centre, ray.direction);
    const double off = glm::length(centre - along * ray.direction), radius = static_cast<double>(sphere.radius);
    if (off > radius) return false;
    const double half = std::sqrt(radius * radius - off * off);
    return half > 1e-3 * radius && along + half > 0.0;
}

std::vector<std::uint32_t> listOf(const TileLists& tiles, int x, int y) {
    const auto tile = static_cast<std::size_t>(y / shared::TILE_EDGE * tiles.across + x / shared::TILE_EDGE);
    return {tiles.lists.begin() + tiles.offsets[tile], tiles.lists.begin() + tiles.offsets[tile + 1]};
}

const std::vector<View> views = {
    {scene::Projection::perspective, 300, 170, 40.0}, {scene::Projection::perspective, 33, 18, 120.0},
    {scene::Projection::perspective, 500, 16, 2.0},   {scene::Projection::orthographic, 250, 140, 40.0},
    {scene::Projection::orthographic, 17, 200, 10.0}, {scene::Projection::panorama, 256, 128, 40.0},
    {scene::Projection::panorama, 200, 150, 40.0},    {scene::Projection::panorama, 40, 20, 40.0},
};

TEST(TileLists, NeverMissASphere) {
    const std::vector<Billboard> spheres = randomSpheres(400, 1);
    for (const View& view : views) {
        const Camera camera = cameraFor(view);
        const TileLists tiles = makeTileLists(camera, spheres);
        ASSERT_EQ(tiles.offsets.size(), static_cast<std::size_t>(tiles.across * tiles.down) + 1);
        std::mt19937 random(2);
        std::uniform_real_distribution<double> uniform(0.0, 1.0);
        int met = 0;
        for (int i = 0; i < 1500; ++i) {
            // also the corners of pixels, which lie at the rim of tiles
            const int x = std::min(static_cast<int>(uniform(random) * view.width), view.width - 1);
            const int y = std::min(static_cast<int>(uniform(random) * view.height), view.height - 1);
            const double inX = i % 3 == 0 ? 0.5 : uniform(random), inY = i % 3 == 0 ? 0.5 : uniform(random);
            const Ray ray = camera.ray(x + inX, y + inY);
            const auto list = listOf(tiles, x, y);
            for (std::uint32_t sphere = 0; sphere < spheres.size(); ++sphere) {
                if (!meets(ray, camera.position, spheres[sphere])) continue;
                ++met;
                ASSERT_TRUE(std::binary_search(list.begin(), list.end(), sphere))
                    << "sphere " << sphere << " at pixel " << x << " " << y << " of " << view.width << " × "
                    << view.height << ", projection " << static_cast<int>(view.projection);
            }
        }
        EXPECT_GT(met, 1000);
    }
}

/// Lists are in the order of blending, and no sphere stands twice in one.
TEST(TileLists, KeepTheOrder) {
    const std::vector<Billboard> spheres = randomSpheres(500, 3);
    for (const View& view : views) {
        const TileLists tiles = makeTileLists(cameraFor(view), spheres);
        for (std::size_t tile = 0; tile + 1 < tiles.offsets.size(); ++tile)
            for (std::uint32_t i = tiles.offsets[tile] + 1; i < tiles.offsets[tile + 1]; ++i)
                ASSERT_LT(tiles.lists[i - 1], tiles.lists[i]);
    }
}

/// Small spheres that the view shows once are in few tiles: the lists are worth their name.
TEST(TileLists, AreShort) {
    std::vector<Billboard> spheres = randomSpheres(500, 4);
    for (Billboard& sphere : spheres) sphere.radius = 1e-3F * glm::length(sphere.centre);
    const Camera camera = cameraFor({scene::Projection::panorama, 512, 256, 40.0});
    const TileLists tiles = makeTileLists(camera, spheres);
    EXPECT_GE(tiles.lists.size(), spheres.size());
    EXPECT_LE(tiles.lists.size(), 5 * spheres.size());
}

TEST(TileLists, LeaveOutWhatParallelRaysHaveBehindThem) {
    const Camera camera = cameraFor({scene::Projection::orthographic, 64, 48, 40.0});
    const dvec3 forward = camera.axes[2];
    const std::vector<Billboard> spheres{{glm::vec3(3.0 * forward), 2.0F, 1.0F, 0.0F},
                                         {glm::vec3(-1.0 * forward), 2.0F, 1.0F, 0.0F},
                                         {glm::vec3(-3.0 * forward), 2.0F, 1.0F, 0.0F}};
    EXPECT_EQ(listOf(makeTileLists(camera, spheres), 32, 24), (std::vector<std::uint32_t>{0, 1}));
}

TEST(TileLists, NothingToDraw) {
    const TileLists tiles = makeTileLists(cameraFor(views[0]), {});
    EXPECT_TRUE(tiles.lists.empty());
    EXPECT_EQ(tiles.offsets.size(), static_cast<std::size_t>(tiles.across * tiles.down) + 1);
}

}  // namespace
}  // namespace lumulus::draw
