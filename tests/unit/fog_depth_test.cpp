// Depth files of other renderers as metres along the ray.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "fog/screen/depth.h"
#include "shared/draw.h"

namespace lumulus::fog {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

Camera row(int width) {
    Camera camera;
    camera.width = width;
    camera.height = 1;
    camera.tanHalfFov = 0.5;
    return camera;
}

TEST(FogDepth, DistancesStayAndWhatHasNoneIsFar) {
    std::array<float, 5> depth{3.0F, 0.0F, infinity, std::numeric_limits<float>::quiet_NaN(), -2.0F};
    EXPECT_EQ(depthToDistance(depth, {}, row(5)), 2U);
    EXPECT_EQ(depth, (std::array<float, 5>{3.0F, 0.0F, shared::FAR_DEPTH, shared::FAR_DEPTH, 0.0F}));
}

TEST(FogDepth, PlanarDepthGrowsTowardsTheEdge) {
    scene::Fog fog;
    fog.depth = scene::FogDepth::planar;
    std::array<float, 3> depth{10.0F, 10.0F, 10.0F};
    depthToDistance(depth, fog, row(3));
    EXPECT_FLOAT_EQ(depth[1], 10.0F);
    // pixel middles lie at ±2/3 of the half width, whose tangent is 3 · .5
    EXPECT_NEAR(depth[0], 10.0 * std::sqrt(2.0), 1e-5);
    EXPECT_FLOAT_EQ(depth[0], depth[2]);
}

TEST(FogDepth, ZBufferBothWays) {
    scene::Fog fog;
    fog.depth = scene::FogDepth::zbuffer;
    fog.near = 0.5;
    fog.far = 200.0;
    const auto z = [&](double metres) {
        return static_cast<float>((1.0 / fog.near - 1.0 / metres) / (1.0 / fog.near - 1.0 / fog.far));
    };
    for (int i = 0; i < 2; ++i) {
        for (const double metres : {0.5, 1.0, 20.0, 200.0}) {
            std::array<float, 1> depth{z(metres)};
            depthToDistance(depth, fog, row(1));
            EXPECT_NEAR(depth[0], metres, 1e-3 * metres);
        }
        std::swap(fog.near, fog.far);  // reversed: 0 at the far end
    }
    std::array<float, 2> beyond{1.5F, infinity};
    depthToDistance(beyond, fog, row(2));
    EXPECT_EQ(beyond[1], shared::FAR_DEPTH);
}

}  // namespace
}  // namespace lumulus::fog
