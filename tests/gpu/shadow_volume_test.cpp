#include "light/shadow_volume.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/packing.hpp>

#include "gpu/transfer.h"
#include "support/cloud_cases.h"
#include "support/field.h"
#include "support/vulkan_fixture.h"

namespace lumulus::light {
namespace {

using glm::dvec3;
using glm::ivec3;

/// The filled grid on the host.
struct DepthGrid {
    ShadowGrid grid;
    std::vector<double> depths;

    double at(const ivec3& texel) const {
        return depths[static_cast<std::size_t>((texel.z * grid.size.y + texel.y) * grid.size.x + texel.x)];
    }
    dvec3 voxelOf(const ivec3& texel) const { return grid.originVoxel + grid.gridToVoxel * dvec3(texel); }
};

class ShadowVolumeTest : public test::VulkanTest {
  protected:
    /// Fills the grid for light that travels along `travel`; the look-up's matrix must agree with the grid's place.
    DepthGrid fill(const cloud::Asset& cloud, const dvec3& travel, double extinction) {
        ShadowVolume sun(context, cloud);
        gpu::Commands commands(context);
        commands.begin();
        sun.record(commands, travel, extinction);
        commands.submit();
        commands.wait();
        DepthGrid result{makeShadowGrid(cloud.size, cloud.voxelToMetres, travel, 32.0 * 1024 * 1024), {}};
        EXPECT_EQ(result.grid.size, sun.image().extent());
        for (const std::uint16_t bits : gpu::download<std::uint16_t>(context, sun.image()))
            result.depths.push_back(static_cast<double>(glm::unpackHalf1x16(bits)));
        for (const ivec3& texel : {ivec3(0), result.grid.size - 1, result.grid.size / 2}) {
            const glm::vec3 found = sun.voxelToTexture() * glm::vec3(result.voxelOf(texel)) + sun.textureOffset();
            EXPECT_LT(glm::distance(dvec3(found), (dvec3(texel) + 0.5) / dvec3(result.grid.size)), 1e-5);
        }
        return result;
    }
};

/// Flat voxels of 50:2:50 m under slanting light: texels are as fine as the voxels, every layer of them is there, and
/// the depth is that of the metres above. Away from the sides, where light enters aside.
TEST_F(ShadowVolumeTest, FlatVoxelsAreResolved) {
    constexpr int height = 24;
    vdb::Volume deck = boxVolume({30, height, 30});
    deck.toWorld.linear = glm::dmat3(dvec3(50.0, 0, 0), dvec3(0, 2.0, 0), dvec3(0, 0, 50.0));
    const cloud::Asset cloud = cloud::prepare(context, deck, test::prepareOptions(100));
    const double extinction = 0.08;
    for (const dvec3 to : {dvec3(0.3, 1.0, 0.0), dvec3(-0.5, 0.6, 0.2), dvec3(0.0, 1.0, 0.0), dvec3(0.4, -0.7, -0.3)}) {
        const dvec3 travel = -glm::normalize(to);
        const DepthGrid grid = fill(cloud, travel, extinction);
        const dvec3 edges = glm::abs(grid.grid.gridToVoxel[2]);
        EXPECT_NEAR(edges.y, 1.0, 1e-9) << "one layer of voxels";
        int inside = 0;
        for (int k = 0; k < grid.grid.size.z; ++k)
            for (int j = 0; j < grid.grid.size.y; ++j)
                for (int i = 0; i < grid.grid.size.x; ++i) {
                    const dvec3 voxel = grid.voxelOf({i, j, k});
                    if (voxel.x < 5.0 || voxel.z < 5.0 || voxel.x > 27.0 || voxel.z > 27.0) continue;
                    const double below = to.y > 0.0 ? height + 2 - voxel.y : voxel.y;  // layers, with one of soft rim
                    if (below < 2.0 || below > height) continue;
                    const double length = (below - 1.0) * 2.0 / std::abs(travel.y);
                    ASSERT_NEAR(grid.at({i, j, k}), extinction * length, 0.002 * extinction * length + 0.002);
                    ++inside;
                }
        EXPECT_GT(inside, 1000);
    }
}

/// A deck lit from above: depth grows by σ a metre from its top down, and stays behind it.
TEST_F(ShadowVolumeTest, SlabFromAbove) {
    constexpr int height = 8;
    // depth [m] at density 1; the density rises from 0 to 1 between ½ and 1½ m below the top of the volume
    const auto lengthAbove = [](double below) {
        if (below < 0.5) return 0.0;
        if (below < 1.5) return 0.5 * std::pow(below - 0.5, 2);
        if (below < height + 0.5) return below - 1.0;
        return height - 0.5 * std::pow(std::max(0.0, height + 1.5 - below), 2);
    };
    const cloud::Asset cloud = cloud::prepare(context, boxVolume({20, height, 20}), test::prepareOptions(100));
    const double extinction = 0.5;
    const DepthGrid grid = fill(cloud, {0.0, -1.0, 0.0}, extinction);
    int inside = 0;
    for (int k = 0; k < grid.grid.size.z; ++k)
        for (int j = 0; j < grid.grid.size.y; ++j)
            for (int i = 0; i < grid.grid.size.x; ++i) {
                const dvec3 voxel = grid.voxelOf({i, j, k});
                if (voxel.x < 1.5 || voxel.z < 1.5 || voxel.x > 20.5 || voxel.z > 20.5) continue;  // the soft rim
                const double below = height + 2 - voxel.y;
                const double length = lengthAbove(below);
                ASSERT_NEAR(grid.at({i, j, k}), extinction * length, 0.02 * extinction) << below << " m below the top";
                ++inside;
            }
    EXPECT_GT(inside, 2000);
}

/// Chords of a ball: at the middle σR, behind it the whole chord 2σ√(R² − b²).
TEST_F(ShadowVolumeTest, BallFromAnySide) {
    constexpr double radius = 20.0, extinction = 0.2;
    const vdb::Volume ball = ballVolume(34, radius);
    const cloud::Asset cloud = cloud::prepare(context, ball, test::prepareOptions(100));
    for (const dvec3& direction : {dvec3(0, -1, 0), dvec3(1, -2, 0.5), dvec3(-3, 1, 2), dvec3(0, 0, 1)}) {
        const dvec3 travel = glm::normalize(direction);
        const DepthGrid grid = fill(cloud, travel, extinction);
        int behind = 0;
        for (int k = 0; k < grid.grid.size.z; ++k)
            for (int j = 0; j < grid.grid.size.y; ++j)
                for (int i = 0; i < grid.grid.size.x; ++i) {
                    const dvec3 place = ball.toWorld.point(grid.voxelOf({i, j, k}));
                    const double along = glm::dot(place, travel);
                    const double b = glm::length(place - along * travel);
                    if (b > 0.8 * radius) continue;  // at the rim a voxel is not thin against the chord
                    const double half = std::sqrt(radius * radius - b * b);
                    const double path = std::clamp(along + half, 0.0, 2.0 * half);
                    // the rim is blurred over a voxel of 1.25 m, more where the ray grazes it
                    ASSERT_NEAR(grid.at({i, j, k}), extinction * path, extinction * 0.6 * radius / half)
                        << b << " " << along;
                    if (along > half + 1.5) {
                        ASSERT_NEAR(grid.at({i, j, k}), extinction * path, 0.02 * extinction * path) << b;
                        ++behind;
                    }
                }
        EXPECT_GT(behind, 500);
    }
}

/// Sheared voxels of unequal edges: each texel against quadrature of the interpolated field towards the sun.
TEST_F(ShadowVolumeTest, ShearedCloudAgreesWithQuadrature) {
    const test::CloudCase c = test::cloudCases()[2];
    const test::Field field(c.volume);
    const cloud::Asset cloud = cloud::prepare(context, c.volume, test::prepareOptions(100));
    const dvec3 travel = glm::normalize(dvec3(0.5, -1.0, 0.3));
    const double extinction = 0.1;
    const DepthGrid grid = fill(cloud, travel, extinction);
    const dvec3 toSun = -glm::inverse(c.volume.toWorld.linear) * travel;
    double worst = 0.0, deepest = 0.0;
    for (int i = 0; i < 4000; ++i) {
        const ivec3 texel((i * 37) % grid.grid.size.x, (i * 11) % grid.grid.size.y, (i * 53) % grid.grid.size.z);
        const dvec3 voxel = grid.voxelOf(texel);
        const dvec3 clamped = glm::clamp(voxel, dvec3(0.0), dvec3(field.size()));
        if (glm::distance(voxel, clamped) > 0.0) continue;
        const double depth = extinction * field.along(voxel, toSun, 8);
        worst = std::max(worst, std::abs(grid.at(texel) - depth));
        deepest = std::max(deepest, depth);
    }
    EXPECT_GT(deepest, 0.5);
    EXPECT_LT(worst, 0.02 * deepest);
}

/// The grid holds every corner of the box and stays within the texels that it may have.
TEST_F(ShadowVolumeTest, GridCoversTheCloud) {
    const cloud::Asset cloud = cloud::prepare(context, test::cloudCases()[1].volume, test::prepareOptions(100));
    for (const double most : {1e3, 1e5, 1e8})
        for (const dvec3& direction : {dvec3(0, -1, 0), dvec3(0, 1, 0), dvec3(1, 1, 1), dvec3(-1, 0, 1e-9)}) {
            const ShadowGrid grid = makeShadowGrid(cloud.size, cloud.voxelToMetres, glm::normalize(direction), most);
            EXPECT_LE(double(grid.size.x) * grid.size.y * grid.size.z, 2.0 * most + 1000.0);
            for (int corner = 0; corner < 8; ++corner) {
                const dvec3 voxel = dvec3(corner & 1, (corner >> 1) & 1, corner >> 2) * dvec3(cloud.size);
                const dvec3 texel = glm::inverse(grid.gridToVoxel) * (voxel - grid.originVoxel);
                for (int axis = 0; axis < 3; ++axis) {
                    EXPECT_GE(texel[axis], -1e-6);
                    EXPECT_LE(texel[axis], grid.size[axis] - 1 + 1e-6);
                }
            }
        }
}

}  // namespace
}  // namespace lumulus::light
