#include "reference/flip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace lumulus::reference {
namespace {

using Picture = std::vector<std::uint8_t>;
constexpr int width = 48, height = 32;

Picture uniform(std::uint8_t r, std::uint8_t g, std::uint8_t b) {
    Picture picture;
    for (int i = 0; i < width * height; ++i) picture.insert(picture.end(), {r, g, b});
    return picture;
}

Picture noise(unsigned seed) {
    std::mt19937 generator(seed);
    Picture picture(3 * width * height);
    for (std::uint8_t& value : picture) value = static_cast<std::uint8_t>(generator() >> 24U);
    return picture;
}

double meanFlip(const Picture& a, const Picture& b, double perDegree = flipPixelsPerDegree) {
    return flipMean(flip(a, b, width, height, perDegree));
}

TEST(Flip, OfEqualPicturesIsZero) {
    const Picture picture = noise(1);
    const std::vector<float> map = flip(picture, picture, width, height);
    EXPECT_EQ(*std::max_element(map.begin(), map.end()), 0.0F);
}

/// Uniform pictures have no features, so the colour pipeline alone counts: white against black has ΔL* = 100;
/// 100^.7 = 25.12 against 41.28 for green and blue, the largest: .95 + .05 (25.12 − 16.51)/(41.28 − 16.51).
TEST(Flip, HasTheColourDifferencesOfThePaper) {
    EXPECT_NEAR(meanFlip(uniform(255, 255, 255), uniform(0, 0, 0)), 0.9674, 2e-4);
    EXPECT_NEAR(meanFlip(uniform(0, 255, 0), uniform(0, 0, 255)), 1.0, 1e-6);
    // ΔL* of 118 and 119 (.390 in lightness): .95/16.51·.390^.7
    EXPECT_NEAR(meanFlip(uniform(118, 118, 118), uniform(119, 119, 119)), 0.95 / 16.51 * 0.517, 0.001);
}

TEST(Flip, IsSymmetricAndBounded) {
    const Picture a = noise(2), b = noise(3);
    const std::vector<float> there = flip(a, b, width, height), back = flip(b, a, width, height);
    for (std::size_t i = 0; i < there.size(); ++i) {
        EXPECT_FLOAT_EQ(there[i], back[i]);
        EXPECT_GE(there[i], 0.0F);
        EXPECT_LE(there[i], 1.0F);
    }
    EXPECT_GT(flipMean(there), 0.1);
}

/// An edge that is missing counts for more than its colours alone: the exponent 1 − ΔE_f lifts it.
TEST(Flip, FeelsEdges) {
    Picture step = uniform(100, 100, 100);
    for (int y = 0; y < height; ++y) {
        for (int x = width / 2; x < width; ++x) {
            for (int c = 0; c < 3; ++c) step[static_cast<std::size_t>(3 * (y * width + x) + c)] = 160;
        }
    }
    const std::vector<float> map = flip(step, uniform(130, 130, 130), width, height);
    const auto at = [&](int x) { return map[static_cast<std::size_t>(16 * width + x)]; };
    EXPECT_GT(at(width / 2), at(2));
    EXPECT_GT(at(width / 2), at(width - 3));
}

TEST(Flip, FadesWithDistance) {
    Picture checker = uniform(90, 90, 90);
    for (int i = 0; i < width * height; ++i) {
        if ((i % width + i / width) % 2 == 0) continue;
        for (int c = 0; c < 3; ++c) checker[static_cast<std::size_t>(3 * i + c)] = 150;
    }
    const Picture grey = uniform(126, 126, 126);
    EXPECT_LT(meanFlip(checker, grey, 100.0), meanFlip(checker, grey, 10.0));
}

}  // namespace
}  // namespace lumulus::reference
