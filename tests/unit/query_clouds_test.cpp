#include <gtest/gtest.h>

#include <random>

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
