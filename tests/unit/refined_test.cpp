// Flat voxels: how wide they look, into how many parts they are divided, and that the parts have the same field.
#include "cloud/refined.h"

#include <gtest/gtest.h>

#include <cmath>

#include "cloud/voxel_shape.h"
#include "support/test_volumes.h"

namespace lumulus::cloud {
namespace {

using glm::dmat3;
using glm::dvec3;
using glm::ivec3;

dmat3 edges(double x, double y, double z) {
    return {dvec3(x, 0, 0), dvec3(0, y, 0), dvec3(0, 0, z)};
}

/// Trilinear between the middles of voxels, in voxel coordinates.
double valueAt(const vdb::Volume& volume, const dvec3& voxel) {
    const dvec3 at = voxel - 0.5;
    const ivec3 first(glm::floor(at));
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const ivec3 step(corner & 1, (corner >> 1) & 1, corner >> 2),
            v = glm::clamp(first + step, ivec3(0), volume.size - 1);
        const dvec3 share = glm::mix(1.0 - (at - dvec3(first)), at - dvec3(first), dvec3(step));
        sum += share.x * share.y * share.z * static_cast<double>(volume.density[volume.index(v.x, v.y, v.z)]);
    }
    return sum;
}

TEST(FlatVoxels, LookAsWideAsTheyAre) {
    const dmat3 flat = edges(50.0, 2.0, 50.0);
    EXPECT_TRUE(hasFlatVoxels(flat));
    EXPECT_FALSE(hasFlatVoxels(edges(10.0, 10.5, 10.0)));
    EXPECT_EQ(shortestEdge(flat), 2.0);
    EXPECT_NEAR(smallestWidth(flat, dvec3(0, 0, -1)), 2.0, 1e-9) << "from the side";
    EXPECT_NEAR(smallestWidth(flat, dvec3(0, -1, 0)), 50.0 * std::sqrt(0.5), 1e-9) << "from above, along the diagonal";
    EXPECT_NEAR(smallestWidth(edges(10.0, 10.0, 10.0), dvec3(1, 0, 0)), 10.0 * std::sqrt(0.5), 1e-9);
    const double slanted = smallestWidth(flat, dvec3(0.0, -std::sin(0.1), -std::cos(0.1)));
    EXPECT_NEAR(slanted, 50.0 * std::sin(0.1), 0.05) << "from a little above";
}

/// Long edges become as short as light needs: the mean free path, or the short edge.
TEST(FlatVoxels, AreDividedAlongTheirLongEdges) {
    const ivec3 size(40, 30, 40);
    EXPECT_EQ(refinement(size, edges(10.0, 10.0, 10.0), 1.0), ivec3(1)) << "cubes stay";
    EXPECT_EQ(refinement(size, edges(50.0, 2.0, 50.0), 1e-4), ivec3(1)) << "thin ones too";
    EXPECT_EQ(refinement(size, edges(50.0, 2.0, 50.0), 0.0), ivec3(1));
    EXPECT_EQ(refinement(size, edges(50.0, 2.0, 50.0), 0.04), ivec3(3, 1, 3));
    EXPECT_EQ(refinement(size, edges(2.0, 50.0, 2.0), 0.04), ivec3(1, 3, 1));
    EXPECT_EQ(refinement(ivec3(400, 300, 400), edges(50.0, 2.0, 50.0), 0.04), ivec3(1)) << "too large";
}

TEST(FlatVoxels, PartsHaveTheSameField) {
    vdb::Volume coarse = test::emptyVolume({6, 5, 7});
    test::fillVolume(coarse, [&](const ivec3& v) { return 0.3 + 0.1 * ((7 * v.x + 3 * v.y + 5 * v.z) % 8); });
    coarse.toWorld = {edges(50.0, 2.0, 40.0), dvec3(100.0, -5.0, 3.0)};
    const ivec3 parts(5, 1, 3);
    const vdb::Volume fine = refined(coarse, parts);
    EXPECT_EQ(fine.size, coarse.size * parts);
    EXPECT_EQ(fine.maximum, coarse.maximum);
    for (const dvec3& voxel :
         {dvec3(0.2, 0.4, 0.1), dvec3(3.3, 2.1, 4.7), dvec3(2.5, 2.5, 2.5), dvec3(5.9, 1.7, 6.2)}) {
        EXPECT_NEAR(valueAt(fine, voxel * dvec3(parts)), valueAt(coarse, voxel), 1e-6);
        EXPECT_LT(glm::distance(fine.toWorld.point(voxel * dvec3(parts)), coarse.toWorld.point(voxel)), 1e-9);
    }
}

TEST(FlatVoxels, TheirLightIsKeptFinerUnlessTheSceneSays) {
    scene::PhotonMap map;
    const scene::PhotonMap flat = forFlatVoxels(map);
    EXPECT_EQ(flat.bands, 8);
    EXPECT_EQ(flat.forwardCut, 6.0);
    EXPECT_EQ(flat.photons, 6'000'000);
    map.photons = 24'000'000;
    EXPECT_EQ(forFlatVoxels(map).photons, 24'000'000);
    map.photons = 100;
    EXPECT_EQ(forFlatVoxels(map).photons, 300);
    map.photonsGiven = map.directionsGiven = true;
    EXPECT_EQ(forFlatVoxels(map), map);
}

}  // namespace
}  // namespace lumulus::cloud
