#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/interrupt.h"
#include "query/clouds.h"
#include "reference/medium.h"
#include "support/test_volumes.h"

namespace lumulus::query {
namespace {

std::shared_ptr<const BrickField> fieldOf(const vdb::Volume& volume) {
    return std::make_shared<const BrickField>(volume);
}

glm::dvec3 pointIn(std::mt19937& random, const glm::dvec3& lower, const glm::dvec3& upper) {
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    const double x = uniform(random), y = uniform(random), z = uniform(random);
    return lower + glm::dvec3(x, y, z) * (upper - lower);
}

/// A rotated place with a size of its own along each axis.
vdb::Affine somePlace(const glm::dvec3& at) {
    return {{{3.0, 1.0, -0.5}, {-0.8, 2.5, 0.3}, {0.4, -0.2, 4.0}}, at};
}

TEST(QueryClouds, ABoxOfOneDensityHasItsLengthTimesItsExtinction) {
    vdb::Volume volume = test::emptyVolume(glm::ivec3(40, 30, 20), glm::dmat3(2.0));
    test::fillVolume(volume, [](const glm::ivec3&) { return 1.5; });
    const Clouds clouds({{fieldOf(volume), volume.toWorld.linear, glm::dvec3(0.0), 0.01}});
    // 38 voxels of 2 m; the density rises and falls between the outermost voxel centres
    const double wanted = 0.01 * 1.5 * 2.0 * 38.0;
    EXPECT_NEAR(clouds.opticalDepth(Way::between({-100.0, 30.0, 20.0}, {200.0, 30.0, 20.0})), wanted, 1e-5 * wanted);
    EXPECT_NEAR(clouds.opticalDepth(Way::between({20.0, 30.0, 20.0}, {30.0, 30.0, 20.0})), 0.01 * 1.5 * 10.0, 1e-6);
    EXPECT_EQ(clouds.opticalDepth(Way::between({20.0, 30.0, 20.0}, {20.0, 30.0, 20.0})), 0.0);
    EXPECT_EQ(clouds.opticalDepth(Way::between({0.0, 61.0, 0.0}, {100.0, 61.0, 0.0})), 0.0);
    EXPECT_EQ(clouds.opticalDepth(Way::between({200.0, 30.0, 20.0}, {300.0, 30.0, 20.0})), 0.0);
}

TEST(QueryClouds, AgreesWithTheReference) {
    const vdb::Volume volume = test::lumpyVolume(glm::ivec3(37, 50, 29), glm::dmat3(1.0), 5);
    for (const glm::dvec3& at : {glm::dvec3(0.0), glm::dvec3(1e7, -3e5, 1e7)}) {
        const vdb::Affine place = somePlace(at);
        const Clouds clouds({{fieldOf(volume), place.linear, place.translation, 0.05}});
        const reference::Medium medium({volume, place}, 0.05);
        std::mt19937 random(7);
        for (int i = 0; i < 300; ++i) {
            const glm::dvec3 from = place.point(pointIn(random, glm::dvec3(-10.0), glm::dvec3(60.0)));
            const glm::dvec3 to = place.point(pointIn(random, glm::dvec3(-10.0), glm::dvec3(60.0)));
            const Way way = Way::between(from, to);
            double wanted = 0.0;
            const Ray ray{way.origin, way.direction};
            for (const reference::OpticalPiece& piece : opticalPieces(medium, medium.toVoxel(ray), way.length))
                wanted += piece.depth;
            EXPECT_NEAR(clouds.opticalDepth(way), wanted, 1e-4 * wanted + 2e-4) << i;
        }
    }
}

vdb::SparseVolume sparseOf(const vdb::Volume& dense, const vdb::LevelRule& rule = {}) {
    vdb::SparseVolume sparse;
    sparse.size = dense.size;
    sparse.maximum = dense.maximum;
    sparse.format = vdb::DensityFormat::r16f;
    sparse.leaves = vdb::leavesOf(dense);
    vdb::layOut(sparse, rule, stopIfInterrupted);
    return sparse;
}

TEST(QueryClouds, BricksHaveTheDepthsOfTheDenseField) {
    for (const glm::ivec3 size : {glm::ivec3(37, 50, 29), glm::ivec3(8, 130, 71)}) {
        vdb::Volume volume = test::lumpyVolume(size, glm::dmat3(1.0), 5);
        vdb::SparseVolume sparse = sparseOf(volume);
        const vdb::Affine place = somePlace({1e5, 0.0, 3.0});
        const Clouds dense({{fieldOf(volume), place.linear, place.translation, 0.05}});
        const double extinction = 0.05 * static_cast<double>(volume.maximum);
        const Clouds bricks(
            {{std::make_shared<const BrickField>(sparse), place.linear, place.translation, extinction}});
        std::mt19937 random(8);
        for (int i = 0; i < 300; ++i) {
            const Way way = Way::between(place.point(pointIn(random, glm::dvec3(-10.0), glm::dvec3(140.0))),
                                         place.point(pointIn(random, glm::dvec3(-10.0), glm::dvec3(60.0))));
            const double wanted = dense.opticalDepth(way);
            EXPECT_NEAR(bricks.opticalDepth(way), wanted, 6e-4 * wanted + 2e-4) << i;  // of half floats
        }
    }
}

/// Bricks of a level that is not the finest, and bricks of one value, against sums of the interpolated density.
TEST(QueryClouds, CoarseAndConstantBricksAreAsShadersSeeThem) {
    vdb::Volume volume = test::emptyVolume(glm::ivec3(70, 66, 90));
    test::fillVolume(volume, [](const glm::ivec3& at) { return at.z > 40 ? 0.75 : 0.5 + 0.4 * std::sin(0.2 * at.x); });
    const auto rule = [](const glm::ivec3& minimum, int) { return minimum.x < 32 ? 1 : 0; };
    vdb::SparseVolume sparse = sparseOf(volume, rule);
    const BrickField field(sparse);
    ASSERT_GT(sparse.counts.constant, 0U);
    ASSERT_GT(sparse.counts.slots[1], 0U);
    const std::vector<std::byte> texels = vdb::allTexels(sparse);
    std::mt19937 random(9);
    for (int i = 0; i < 50; ++i) {
        const glm::dvec3 from = pointIn(random, glm::dvec3(1.0), glm::dvec3(65.0, 61.0, 85.0));
        const glm::dvec3 to = pointIn(random, glm::dvec3(1.0), glm::dvec3(65.0, 61.0, 85.0));
        constexpr int steps = 4000;
        double sum = 0.0;
        for (int step = 0; step < steps; ++step)
            sum += static_cast<double>(
                vdb::densityAt(sparse, texels, glm::vec3(from + (step + 0.5) / steps * (to - from))));
        const double length = glm::length(to - from);
        const double wanted = sum / steps * length;
        EXPECT_NEAR(field.integral({from, (to - from) / length}, 0.0, length), wanted, 1e-3 * wanted + 1e-3) << i;
    }
}

TEST(QueryClouds, PartsOfAWayAddUp) {
    const vdb::Volume volume = test::lumpyVolume(glm::ivec3(64), glm::dmat3(1.0), 3);
    const Clouds clouds({{fieldOf(volume), glm::dmat3(5.0), glm::dvec3(0.0), 0.02}});
    std::mt19937 random(11);
    for (int i = 0; i < 200; ++i) {
        const glm::dvec3 a = pointIn(random, glm::dvec3(-50.0), glm::dvec3(350.0));
        const glm::dvec3 c = pointIn(random, glm::dvec3(-50.0), glm::dvec3(350.0));
        const glm::dvec3 b = glm::mix(a, c, 0.3);
        const double whole = clouds.opticalDepth(Way::between(a, c));
        const double parts = clouds.opticalDepth(Way::between(a, b)) + clouds.opticalDepth(Way::between(b, c));
        EXPECT_NEAR(parts, whole, 1e-5 * whole + 1e-6);
        EXPECT_NEAR(clouds.opticalDepth(Way::between(c, a)), whole, 1e-5 * whole + 1e-6);
    }
}

/// Up to the distance that is found the integral is what was asked for; what the whole line does not have is not found.
TEST(QueryClouds, ADepthIsReachedWhereTheIntegralHasIt) {
    const vdb::Volume volume = test::lumpyVolume(glm::ivec3(40, 33, 29), glm::dmat3(1.0), 3);
    const BrickField field(volume);
    std::mt19937 random(4);
    std::uniform_real_distribution<double> uniform(0.01, 0.99);
    for (int i = 0; i < 300; ++i) {
        const glm::dvec3 from = pointIn(random, glm::dvec3(-10.0), glm::dvec3(50.0));
        const glm::dvec3 to = pointIn(random, glm::dvec3(-10.0), glm::dvec3(50.0));
        const VoxelLine line{from, glm::normalize(to - from)};
        const double length = glm::length(to - from), whole = field.integral(line, 0.0, length);
        const double wanted = uniform(random) * whole;
        if (!(whole > 1e-3)) continue;
        const double at = field.reach(line, 0.0, length, wanted);
        ASSERT_TRUE(at > 0.0 && at <= length) << i;
        EXPECT_NEAR(field.integral(line, 0.0, at), wanted, 0.02 * whole + 1e-3) << i;
        EXPECT_FALSE(std::isfinite(field.reach(line, 0.0, length, 1.001 * whole))) << i;
    }
}

TEST(QueryClouds, HalfTheDensityTwiceIsTheWhole) {
    const vdb::Volume volume = test::lumpyVolume(glm::ivec3(32), glm::dmat3(1.0), 9);
    const auto field = fieldOf(volume);
    const glm::dmat3 edges(4.0);
    const Clouds whole({{field, edges, glm::dvec3(0.0), 0.08}});
    const Clouds halves({{field, edges, glm::dvec3(0.0), 0.04}, {field, edges, glm::dvec3(0.0), 0.04}});
    EXPECT_EQ(halves.bytes(), whole.bytes());
    const Way way = Way::between({-10.0, 20.0, 50.0}, {150.0, 90.0, 70.0});
    EXPECT_NEAR(halves.opticalDepth(way), whole.opticalDepth(way), 1e-12);
}

TEST(QueryClouds, ManyCloudsAreTheSumOfEach) {
    const vdb::Volume volume = test::lumpyVolume(glm::ivec3(16), glm::dmat3(1.0), 2);
    const auto field = fieldOf(volume);
    std::mt19937 random(4);
    std::vector<PlacedField> fields;
    for (int i = 0; i < 100; ++i)
        fields.push_back({field, somePlace({}).linear, pointIn(random, glm::dvec3(-500.0), glm::dvec3(500.0)), 0.01});
    fields.push_back({field, glm::dmat3(1.0), glm::dvec3(0.0), 0.0});  // nothing is there
    const Clouds all(fields);
    EXPECT_EQ(all.size(), 100);
    for (int i = 0; i < 50; ++i) {
        const Way way = Way::between(pointIn(random, glm::dvec3(-700.0), glm::dvec3(700.0)),
                                     pointIn(random, glm::dvec3(-700.0), glm::dvec3(700.0)));
        double sum = 0.0;
        for (const PlacedField& one : fields) sum += Clouds({one}).opticalDepth(way);
        EXPECT_NEAR(all.opticalDepth(way), sum, 1e-9 * sum);
    }
    const glm::dvec3 middle = fields[0].origin + fields[0].voxelToMetres * glm::dvec3(8.0);
    EXPECT_GT(all.opticalDepth({middle - glm::dvec3(0.0, 0.0, 2000.0), {0.0, 0.0, 1.0}}), 0.0);  // without an end
}

}  // namespace
}  // namespace lumulus::query
