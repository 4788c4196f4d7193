#include "shared/rng.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "support/deviation.h"
#include "support/statistics.h"

namespace lumulus {
namespace {

using shared::rngUniform4;
using shared::uvec4;
using shared::vec4;

constexpr int draws = 1 << 20;
constexpr double deviations = 5.0;  // standard errors; all tests together make some 300 comparisons

/// Keys as photons use them: one component counts up, the others stay.
uvec4 keyAlong(int component, int i) {
    uvec4 key(12345U, 3U, 7U, shared::rngStream(42U, 0U, 0U));
    key[component] = static_cast<std::uint32_t>(i);
    return key;
}

class AlongKey : public ::testing::TestWithParam<int> {};

TEST_P(AlongKey, NumbersAreUniform) {
    constexpr int bins = 1024;
    std::array<std::vector<double>, 4> counts;
    counts.fill(std::vector<double>(bins, 0.0));
    std::array<test::RunningMean, 4> means;
    for (int i = 0; i < draws; ++i) {
        const vec4 u = rngUniform4(keyAlong(GetParam(), i));
        for (int k = 0; k < 4; ++k) {
            ASSERT_GE(u[k], 0.0F);
            ASSERT_LT(u[k], 1.0F);
            counts[static_cast<std::size_t>(k)][static_cast<std::size_t>(u[k] * bins)] += 1.0;
            means[static_cast<std::size_t>(k)].add(static_cast<double>(u[k]));
        }
    }
    const std::vector<double> expected(bins, static_cast<double>(draws) / bins);
    for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_NEAR(means[k].mean(), 0.5, deviations * means[k].standardError()) << "word " << k;
        EXPECT_LT(std::abs(test::chiSquareDeviation(counts[k], expected)), deviations) << "word " << k;
    }
}

/// Pairs (u, v) of all words at lag 0 to 3 fill the square evenly: any smooth dependence between neighbours shows.
TEST_P(AlongKey, PairsAreUniform) {
    constexpr int side = 32;
    for (int lag = 0; lag <= 3; ++lag) {
        std::array<std::vector<double>, 16> counts;
        counts.fill(std::vector<double>(side * side, 0.0));
        for (int i = 0; i < draws / 4; ++i) {
            const vec4 u = rngUniform4(keyAlong(GetParam(), i));
            const vec4 v = rngUniform4(keyAlong(GetParam(), i + lag));
            for (int k = 0; k < 16; ++k) {
                const auto x = static_cast<std::size_t>(u[k / 4] * side);
                const auto y = static_cast<std::size_t>(v[k % 4] * side);
                counts[static_cast<std::size_t>(k)][x * side + y] += 1.0;
            }
        }
        const std::vector<double> expected(side * side, draws / 4.0 / (side * side));
        for (int k = 0; k < 16; ++k) {
            if (lag == 0 && k / 4 == k % 4) {
                continue;  // a word with itself
            }
            const double deviation = test::chiSquareDeviation(counts[static_cast<std::size_t>(k)], expected);
            EXPECT_LT(std::abs(deviation), deviations) << "words " << k / 4 << ", " << k % 4 << ", lag " << lag;
        }
    }
}

TEST_P(AlongKey, NeighboursDoNotCorrelate) {
    for (const int lag : {1, 2, 3, 8, 64, 1024}) {
        for (int word = 0; word < 4; ++word) {
            test::RunningMean product;  // of centred numbers: mean 0
            for (int i = 0; i < draws / 4; ++i) {
                const double u = static_cast<double>(rngUniform4(keyAlong(GetParam(), i))[word]) - 0.5;
                const double v = static_cast<double>(rngUniform4(keyAlong(GetParam(), i + lag))[word]) - 0.5;
                product.add(u * v);
            }
            EXPECT_LT(std::abs(product.mean()), deviations * product.standardError())
                << "word " << word << ", lag " << lag;
        }
    }
}

TEST_P(AlongKey, BitsAreBalancedAndFlipIndependently) {
    constexpr int count = draws / 4;
    const double error = 0.5 * std::sqrt(static_cast<double>(count));
    for (int word = 0; word < 4; ++word) {
        std::array<int, 24> ones{};
        std::array<int, 24> flips{};
        std::uint32_t before = 0;
        for (int i = 0; i < count; ++i) {
            const std::uint32_t bits = shared::pcg4d(keyAlong(GetParam(), i))[word] >> 8U;
            for (std::size_t b = 0; b < 24; ++b) {
                ones[b] += static_cast<int>((bits >> b) & 1U);
                flips[b] += static_cast<int>(((bits ^ before) >> b) & 1U);
            }
            before = bits;
        }
        for (std::size_t b = 0; b < 24; ++b) {
            EXPECT_NEAR(ones[b], count / 2.0, deviations * error) << "word " << word << ", bit " << b;
            EXPECT_NEAR(flips[b], count / 2.0, deviations * error) << "word " << word << ", bit " << b;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Rng, AlongKey, ::testing::Values(0, 1, 2, 3));

/// The first three numbers of each photon choose where it starts: they fill the cube evenly.
TEST(Rng, PhotonsAreEvenlySpreadInThreeDimensions) {
    constexpr std::size_t side = 16;
    std::vector<double> counts(side * side * side, 0.0);
    for (int i = 0; i < draws; ++i) {
        const vec4 u = rngUniform4(uvec4(static_cast<std::uint32_t>(i), 0U, 0U, shared::rngStream(1U, 0U, 0U)));
        const auto cell = [&u](int k) { return static_cast<std::size_t>(u[k] * static_cast<float>(side)); };
        counts[(cell(0) * side + cell(1)) * side + cell(2)] += 1.0;
    }
    const std::vector<double> expected(counts.size(), static_cast<double>(draws) / static_cast<double>(counts.size()));
    EXPECT_LT(std::abs(test::chiSquareDeviation(counts, expected)), deviations);
}

TEST(Rng, EveryPartOfTheKeyMatters) {
    const std::uint32_t stream = shared::rngStream(1U, 2U, 3U);
    EXPECT_NE(stream, shared::rngStream(2U, 2U, 3U));
    EXPECT_NE(stream, shared::rngStream(1U, 3U, 3U));
    EXPECT_NE(stream, shared::rngStream(1U, 2U, 4U));
}

/// The listing of the paper, worked out with Python's integers modulo 2³².
TEST(Rng, KnownValues) {
    EXPECT_EQ(shared::pcg4d(uvec4(0U)), uvec4(251852841U, 760645481U, 850445371U, 3542436074U));
    EXPECT_EQ(shared::pcg4d(uvec4(1U, 2U, 3U, 4U)), uvec4(908250390U, 4044648920U, 3775961919U, 45698095U));
}

}  // namespace
}  // namespace lumulus
