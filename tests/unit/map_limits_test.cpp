// What a photon map can hold, and the numbers that stay whole with 2³¹ photons and more.
#include "light/photon/map_limits.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "base/error.h"
#include "light/photon/emission.h"
#include "shared/photon.h"
#include "support/photon_setup.h"

namespace lumulus::photon {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr std::uint64_t mebi = std::uint64_t{1} << 20U;

/// 1024 collectors with 8 bands: 1.5 MiB a generation.
MapSize sizeOf(int generations, bool keepRing) {
    return {1024, 8, generations, keepRing};
}

std::string refusal(const MapSize& size, std::uint64_t budget, std::uint64_t largestBuffer) {
    try {
        requireMapFits(size, budget, largestBuffer);
    } catch (const InputError& e) {
        return e.what();
    }
    return "";
}

TEST(MapLimits, CountAllCoefficients) {
    EXPECT_EQ(generationBytes(sizeOf(20, true)), 1024U * 3 * 64 * 8);
    EXPECT_EQ(mapBytes(sizeOf(20, false)), 3 * mebi);
    EXPECT_EQ(mapBytes(sizeOf(20, true)), 33 * mebi);
    EXPECT_EQ(generationBytes({16777216, 8, 1, false}), std::uint64_t{24576} * mebi) << "most leaves, most bands";
}

TEST(MapLimits, TheBudgetIsKept) {
    EXPECT_EQ(refusal(sizeOf(4096, true), 4098 * 3 * mebi / 2, 128 * mebi), "");
    EXPECT_THAT(refusal(sizeOf(4096, true), 1024 * mebi, 128 * mebi),
                AllOf(HasSubstr("6147.00 MiB"), HasSubstr("4098 times 1.50 MiB"), HasSubstr("ring of 4096"),
                      HasSubstr("budget is 1024.00 MiB (photon_map.memory_budget)"),
                      HasSubstr("lower photon_map.bands, preparation.max_leaves or photon_map.generations")));
    EXPECT_EQ(refusal(sizeOf(4096, false), 3 * mebi, 128 * mebi), "") << "without a ring generations take no memory";
    EXPECT_THAT(refusal(sizeOf(4096, false), 3 * mebi - 1, 128 * mebi), HasSubstr("3.00 MiB, 2 times 1.50 MiB"));
    EXPECT_THAT(refusal({1025, 8, 1, false}, 3 * mebi, 128 * mebi), HasSubstr("needs 3.01 MiB"))
        << "a little too much does not read like what fits";
}

TEST(MapLimits, SplitGenerationsTakeOneMore) {
    const MapSize halves{1024, 8, 20, false, true};
    EXPECT_EQ(mapBytes(halves), 9 * mebi / 2);
    EXPECT_EQ(refusal(halves, 9 * mebi / 2, 128 * mebi), "");
    EXPECT_THAT(refusal(halves, 9 * mebi / 2 - 1, 128 * mebi),
                HasSubstr("3 times 1.50 MiB for the newest generation of each half and the sum of all"));
}

TEST(MapLimits, OneGenerationFitsIntoABufferOfTheDevice) {
    EXPECT_EQ(refusal({87381, 8, 1, false}, 1024 * mebi, 128 * mebi), "");
    EXPECT_THAT(refusal({87382, 8, 1, false}, 1024 * mebi, 128 * mebi),
                AllOf(HasSubstr("87382 collectors with 8 bands"), HasSubstr("128.00 MiB (photon_map.bands)")));
}

/// The sums of one generation are 64 bits wide and are not watched while they grow.
TEST(MapLimits, RecordsBeyondWhatSumsHoldAreRefused) {
    // the largest record: 21 bits of power; y_70, the largest harmonic of 8 bands, is √(15/4π) = 1.09
    const double most = 2097151.0 * static_cast<double>(shared::COEFFICIENT_SCALE) * 1.0926;
    EXPECT_LT(most * 0x1p38, static_cast<double>(std::numeric_limits<std::int64_t>::max()));
    EXPECT_NO_THROW(requireCountable(std::uint64_t{1} << 38U));
    EXPECT_THROW(requireCountable((std::uint64_t{1} << 38U) + 1), Error);
}

/// 2³¹ photons, and the most that a generation may have: shares and powers are exact to the last photon.
TEST(ManyPhotons, ShareOutExactly) {
    const glm::dmat3 faces = faceAreas(glm::dmat3(1.0), glm::dvec3(10.0));
    const Emission emission = makeEmission(test::sunFrom({0, 1, 0}, {3, 1, 2}), test::skyOf({0.1, 0.2, 0.3}), faces);
    for (const std::uint64_t photons : {std::uint64_t{1} << 31U, std::uint64_t{0xF0000000}}) {
        const std::uint64_t least = emission.sunPhotons(photons, 0.0);
        EXPECT_LE(emission.sunPhotons(photons, 1.0 - 0x1p-32), least + 1);
        EXPECT_NEAR(static_cast<double>(least), emission.sunShare * static_cast<double>(photons), 1.0);
        EXPECT_LE(least, photons);
        const double ofSun = emission.sunShare * static_cast<double>(photons);
        EXPECT_NEAR(emission.sunPower(photons).x * ofSun / emission.sunFlux.x, 1.0, 1e-12);
        const double ofSky = (1.0 - emission.sunShare) * static_cast<double>(photons);
        EXPECT_NEAR(emission.skyPower(photons).z * ofSky / emission.skyFlux.z, 1.0, 1e-12);
        // an invocation's number steps past the last photon by at most the number of invocations (65536)
        EXPECT_LE(photons + 65536, std::uint64_t{std::numeric_limits<std::uint32_t>::max()});
    }
}

}  // namespace
}  // namespace lumulus::photon
