#include "vdb/sparse_volume.h"

#include <gtest/gtest.h>

#include <random>

#include "support/test_volumes.h"
#include "vdb/procedural.h"

namespace lumulus::vdb {
namespace {

SparseVolume sparseOf(const Volume& dense, DensityFormat format, const LevelRule& rule = {}) {
    SparseVolume sparse;
    sparse.size = dense.size;
    sparse.maximum = dense.maximum;
    sparse.toWorld = dense.toWorld;
    sparse.format = format;
    sparse.leaves = leavesOf(dense);
    layOut(sparse, rule, stopIfInterrupted);
    return sparse;
}

/// The interpolated density of a dense volume, of the maximum.
double denseAt(const Volume& volume, const glm::vec3& voxel) {
    const glm::vec3 centred = glm::clamp(voxel - 0.5F, glm::vec3(0.0F), glm::vec3(volume.size) - 1.0F);
    const glm::ivec3 first = glm::min(glm::ivec3(centred), volume.size - 2);
    const glm::dvec3 part = glm::dvec3(centred) - glm::dvec3(first);
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::ivec3 step(corner & 1, corner >> 1 & 1, corner >> 2);
        const glm::dvec3 weight = glm::mix(1.0 - part, part, glm::dvec3(step));
        const glm::ivec3 at = first + step;
        sum += weight.x * weight.y * weight.z * static_cast<double>(volume.density[volume.index(at.x, at.y, at.z)]);
    }
    return sum / static_cast<double>(volume.maximum);
}

std::vector<glm::vec3> randomPlaces(const glm::ivec3& size, int count) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> uniform(0.0F, 1.0F);
    std::vector<glm::vec3> places;
    for (int i = 0; i < count; ++i)
        places.push_back(glm::vec3(size) * glm::vec3(uniform(random), uniform(random), uniform(random)));
    return places;
}

TEST(SparseVolume, HasTheDenseValuesAtRandomPlaces) {
    for (const glm::ivec3 size : {glm::ivec3(40, 61, 97), glm::ivec3(16), glm::ivec3(13, 130, 19)}) {
        const Volume dense = test::lumpyVolume(size, glm::dmat3(1.0), 3);
        for (const DensityFormat format : {DensityFormat::r8, DensityFormat::r16f}) {
            SparseVolume sparse = sparseOf(dense, format);
            const std::vector<std::byte> texels = allTexels(sparse);
            ASSERT_EQ(texels.size(), sparse.slots.size() * SparseVolume::slotTexels * texelBytes(format));
            // half a step of eight bits, or 11 binary digits; the greatest value of a brick is stored up to 1/1024
            // above
            const double tolerance = format == DensityFormat::r8 ? 0.5 / 255.0 + 1e-5 : 0x1p-11;
            for (const glm::vec3& place : randomPlaces(size, 20000))
                ASSERT_NEAR(static_cast<double>(densityAt(sparse, texels, place)), denseAt(dense, place), tolerance)
                    << place.x << " " << place.y << " " << place.z;
        }
    }
}

TEST(SparseVolume, ConstantAndEmptyBricksTakeNoTexels) {
    Volume dense = test::emptyVolume(glm::ivec3(96));
    test::fillVolume(dense, [](const glm::ivec3& at) {
        return glm::all(glm::greaterThanEqual(at, glm::ivec3(16))) && glm::all(glm::lessThan(at, glm::ivec3(64))) ? 0.5
                                                                                                                  : 0.0;
    });
    SparseVolume sparse = sparseOf(dense, DensityFormat::r8);
    // 6³ bricks of one value, of which those that have others above them on all axes, 5³, see nothing but it; the
    // layers below touch the cube by their last half voxel
    EXPECT_EQ(sparse.counts.constant, 125U);
    EXPECT_EQ(sparse.counts.dense, 343U - 125U);
    EXPECT_EQ(sparse.counts.empty, 12U * 12U * 12U - 343U);
    EXPECT_EQ(sparse.slots.size(), sparse.counts.dense);
    const std::vector<std::byte> texels = allTexels(sparse);
    for (const glm::vec3& place : randomPlaces(dense.size, 20000))
        ASSERT_NEAR(static_cast<double>(densityAt(sparse, texels, place)), denseAt(dense, place), 1e-6);
    EXPECT_EQ(sparse.relativeError, 0.0);
}

TEST(SparseVolume, MajorantsBoundTheInterpolationAndTouchIt) {
    const Volume dense = test::lumpyVolume({50, 70, 45}, glm::dmat3(1.0), 9);
    for (const int level : {0, 1, 3}) {
        SparseVolume sparse = sparseOf(
            dense, DensityFormat::r8, level == 0 ? LevelRule{} : [&](const glm::ivec3&, int) { return level; });
        const std::vector<std::byte> texels = allTexels(sparse);
        const glm::ivec3 cells = sparse.cells();
        double slack = 0.0, sum = 0.0;
        std::vector<float> seen(sparse.cellMajorants.size(), 0.0F);
        for (const glm::vec3& place : randomPlaces(dense.size, 400000)) {
            const glm::ivec3 cell = glm::ivec3(place) / (8 * sparse.cellBricks);
            const auto number = static_cast<std::size_t>((cell.z * cells.y + cell.y) * cells.x + cell.x);
            const float value = densityAt(sparse, texels, place);
            ASSERT_LE(value, sparse.cellMajorants[number] * (1.0F + 1e-5F));
            seen[number] = std::max(seen[number], value);
        }
        for (std::size_t i = 0; i < seen.size(); ++i) {
            slack += static_cast<double>(sparse.cellMajorants[i] - seen[i]);
            sum += static_cast<double>(sparse.cellMajorants[i]);
        }
        // random places seldom meet the very texel, and cells of coarse levels share theirs
        EXPECT_LT(slack, (level == 0 ? 0.25 : 0.6) * sum) << level;
    }
}

TEST(SparseVolume, CoarseLevelsKeepTheMassAndMeetFineOnes) {
    Volume dense = test::emptyVolume({100, 64, 70});
    test::fillVolume(dense, [](const glm::ivec3& at) {
        const double d = glm::length(glm::dvec3(at) - glm::dvec3(48.0, 33.0, 36.0));
        return std::max(0.0, 1.0 - d / 20.0) * (0.7 + 0.3 * std::sin(0.9 * at.x) * std::cos(0.7 * at.y + 0.3 * at.z));
    });
    double exact = 0.0;
    for (const float value : dense.density) exact += static_cast<double>(value / dense.maximum);
    std::uint64_t before = ~std::uint64_t{0};
    for (int level = 0; level <= 3; ++level) {
        // one half of the box is coarse
        SparseVolume sparse = sparseOf(dense, DensityFormat::r16f, [&](const glm::ivec3& minimum, int edge) {
            return minimum.x + edge > 48 ? 0 : level;
        });
        const std::vector<std::byte> texels = allTexels(sparse);
        EXPECT_LE(sparse.slots.size(), before);
        before = sparse.slots.size();
        double mass = 0.0, error = 0.0;
        for (int z = 0; z < dense.size.z; ++z)
            for (int y = 0; y < dense.size.y; ++y)
                for (int x = 0; x < dense.size.x; ++x) {
                    const glm::vec3 centre = glm::vec3(x, y, z) + 0.5F;
                    const auto value = static_cast<double>(densityAt(sparse, texels, centre));
                    mass += value;
                    error += std::abs(value - denseAt(dense, centre));
                }
        EXPECT_NEAR(mass, exact, (level == 0 ? 1e-4 : 0.01) * exact) << level;
        EXPECT_LT(error, (level == 0 ? 0.001 : 0.12 * level) * exact) << level;
    }
}

TEST(SparseVolume, CodesMeetTheTolerance) {
    const Volume cloud = makeCloud({"cumulus", 96, 1});
    const LeafTable leaves = leavesOf(cloud);
    const DensityFormat format = chooseFormat(leaves);
    SparseVolume sparse = sparseOf(cloud, format);
    allTexels(sparse);
    EXPECT_LT(sparse.relativeError, 2e-3);
    std::printf("cumulus 96: %s, error %.2e, %zu slots of %d bricks\n", format == DensityFormat::r8 ? "R8" : "R16F",
                sparse.relativeError, sparse.slots.size(), 12 * 12 * 12);
}

}  // namespace
}  // namespace lumulus::vdb
