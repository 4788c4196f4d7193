#include "frame/background.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace lumulus::frame {
namespace {

using glm::dvec3;

struct Sight {
    scene::Sun sun;
    scene::Sky sky;
    scene::Camera camera;

    Sight() {
        sun.directionTo = glm::normalize(dvec3(0.2, 0.1, -1.0));
        sun.angularDiameter = 7.0;
        camera.position = dvec3(0.0);
        camera.target = dvec3(0.0, 0.0, -1.0);
    }
    LayeredImage picture(int across, int rays, const Tile& without = {0, 0, 0, 0}) const {
        const Camera seen = makeCamera(camera, {across, across * 3 / 4, 0.0}, Bounds{});
        return skyImage(seen, {0, 0, across, across * 3 / 4}, sun, sky, rays, without);
    }
};

/// Three rays along each side of a pixel are those of the nine pixels of a picture three times as large.
TEST(Sky, RaysOfAPixelAreItsMean) {
    const Sight sight;
    const LayeredImage coarse = sight.picture(40, 3), fine = sight.picture(120, 1);
    int partly = 0;
    for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 40; ++x) {
            double mean = 0.0;
            for (int i = 0; i < 9; ++i)
                mean += static_cast<double>(
                            fine.layers.at("G")[static_cast<std::size_t>((3 * y + i / 3) * 120 + 3 * x + i % 3)]) /
                        9.0;
            const auto found = static_cast<double>(coarse.layers.at("G")[static_cast<std::size_t>(y * 40 + x)]);
            ASSERT_NEAR(found, mean, 1e-6 * mean) << x << " " << y;
            partly += found > 1.01 * sight.sky.radiance.g &&
                      found < 0.9 * static_cast<double>(*std::ranges::max_element(coarse.layers.at("G")));
        }
    EXPECT_GT(partly, 3) << "the rim of the disc";
}

TEST(Sky, LeavesOutTheDiscWhereItIsDrawnLater) {
    const Sight sight;
    const Tile part{24, 8, 4, 10};
    const LayeredImage whole = sight.picture(40, 1), without = sight.picture(40, 1, part);
    int left = 0;
    for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 40; ++x) {
            const bool inside = x >= part.x && x < part.x + part.width && y >= part.y && y < part.y + part.height;
            const auto i = static_cast<std::size_t>(y * 40 + x);
            const float expected = inside ? static_cast<float>(sight.sky.radiance.g) : whole.layers.at("G")[i];
            ASSERT_EQ(without.layers.at("G")[i], expected) << x << " " << y;
            left += without.layers.at("G")[i] != whole.layers.at("G")[i];
        }
    EXPECT_GT(left, 3);
}

}  // namespace
}  // namespace lumulus::frame
