// The noise of a picture from two pictures that share no photons.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "progressive/noise.h"

namespace lumulus::progressive {
namespace {

LayeredImage grey(int width, int height, float radiance, float transmittance) {
    LayeredImage image;
    image.width = width;
    image.height = height;
    for (const char* colour : {"R", "G", "B"}) {
        image.layer(colour, radiance);
        image.layer(std::string("transmittance.") + colour, transmittance);
    }
    return image;
}

Preview previewOf(const LayeredImage& even, const LayeredImage& odd, int evenGenerations, int oddGenerations) {
    Preview preview{even, odd, {}, evenGenerations, oddGenerations, 0.0};
    for (int row = 0; row < even.height; ++row) preview.rows.push_back(row);
    return preview;
}

/// A = 1.1, B = 0.9: R = 1, (A−B)² = .04; two halves of equal size make a quarter of it, over 1 + .01.
TEST(Noise, OfTwoEqualHalves) {
    const Preview preview = previewOf(grey(4, 3, 1.1F, 0.5F), grey(4, 3, 0.9F, 0.5F), 3, 3);
    EXPECT_NEAR(noiseOf(preview, 6), 0.01 / 1.01, 1e-7);
    EXPECT_NEAR(noiseOf(preview, 60), 0.001 / 1.01, 1e-8) << "nine tenths of the photons were not in the halves";
}

/// The halves' noise goes with their own sizes: R weighs them by it.
TEST(Noise, OfHalvesOfDifferentSizes) {
    const Preview preview = previewOf(grey(4, 3, 1.0F, 0.5F), grey(4, 3, 1.3F, 0.5F), 2, 1);
    EXPECT_NEAR(noiseOf(preview, 3), 0.09 * (2.0 / 9.0) / (1.01 * 1.1 * 1.1), 1e-7);
}

TEST(Noise, CountsOnlyRowsThatAreDrawnAndShowTheCloud) {
    Preview preview = previewOf(grey(2, 3, 1.1F, 0.5F), grey(2, 3, 0.9F, 0.5F), 1, 1);
    preview.rows = {0, 1};
    for (const char* colour : {"R", "G", "B"}) {
        preview.even.layer(colour)[4] = 100.0F;  // the last row is not drawn
        preview.even.layer(colour)[3] = 7.0F;    // sky
        preview.even.layer(std::string("transmittance.") + colour)[3] = 0.9995F;
    }
    EXPECT_NEAR(noiseOf(preview, 2), 0.01 / 1.01, 1e-7);
    EXPECT_EQ(noiseOf(previewOf(grey(2, 2, 1.0F, 1.0F), grey(2, 2, 2.0F, 1.0F), 1, 1), 2), 0.0) << "no cloud";
    EXPECT_EQ(noiseOf(previewOf(grey(2, 2, 0.0F, 0.5F), grey(2, 2, 0.0F, 0.5F), 1, 1), 2), 0.0) << "no light";
}

/// Pixels 1 + s·N(0,1)/√generations: the estimate is s²/generations over 1.01, whatever the shares of the halves.
TEST(Noise, IsThatOfTheWhole) {
    constexpr int width = 300, height = 200, generations = 12;
    constexpr double s = 0.2;
    std::mt19937 random(7);
    std::normal_distribution<float> normal;
    for (const int even : {6, 3}) {
        Preview preview =
            previewOf(grey(width, height, 1.0F, 0.5F), grey(width, height, 1.0F, 0.5F), even, generations - even);
        for (const char* colour : {"R", "G", "B"}) {
            for (float& value : preview.even.layer(colour))
                value += static_cast<float>(s / std::sqrt(even)) * normal(random);
            for (float& value : preview.odd.layer(colour))
                value += static_cast<float>(s / std::sqrt(generations - even)) * normal(random);
        }
        const double exact = s * s / generations / 1.01;
        // the squares spread by √2 of themselves; R, which is noisy too, adds about 3 s²/generations
        EXPECT_NEAR(noiseOf(preview, generations), exact, (4.0 * std::sqrt(2.0 / (3 * width * height)) + 0.01) * exact);
    }
}

}  // namespace
}  // namespace lumulus::progressive
