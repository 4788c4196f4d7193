#include "reference/metrics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "base/error.h"
#include "reference/difference_picture.h"

namespace lumulus::reference {
namespace {

using testing::HasSubstr;

/// All three channels of every pixel at `value`.
LayeredImage uniform(int width, int height, float value) {
    LayeredImage image;
    image.width = width;
    image.height = height;
    for (const char* name : {"R", "G", "B"}) image.layer(name, value);
    return image;
}

void addVariance(LayeredImage& image, float variance) {
    for (const char* name : {"variance.R", "variance.G", "variance.B"}) image.layer(name, variance);
}

TEST(Compare, FindsNothingBetweenEqualPictures) {
    const LayeredImage image = uniform(4, 3, 0.7F);
    const Comparison result = compare(image, image);
    EXPECT_EQ(result.pixels, 12U);
    EXPECT_EQ(result.rmse.value, 0.0);
    EXPECT_EQ(result.relMse.value, 0.0);
    EXPECT_EQ(result.bias.value, 0.0);
    EXPECT_EQ(result.mape.value, 0.0);
    EXPECT_FALSE(result.rmse.standardError.has_value());
}

/// What is relative to nothing is nothing, or beyond all numbers; never no number.
TEST(Compare, KnowsBlack) {
    LayeredImage black = uniform(4, 3, 0.0F);
    addVariance(black, 0.0F);
    for (const Comparison& same : {compare(black, black), compare(black, black, black)}) {
        for (const Measure& measure : {same.rmse, same.relMse, same.bias, same.relativeBias, same.mape}) {
            EXPECT_EQ(measure.value, 0.0);
            EXPECT_EQ(measure.standardError, 0.0);
        }
        EXPECT_EQ(same.referenceNoise, 0.0);
    }
    const Comparison other = compare(uniform(4, 3, 0.5F), black);
    EXPECT_DOUBLE_EQ(other.rmse.value, 0.5);
    EXPECT_DOUBLE_EQ(other.bias.value, 0.5);
    for (const Measure& measure : {other.relMse, other.relativeBias, other.mape}) {
        EXPECT_EQ(measure.value, std::numeric_limits<double>::infinity());
        EXPECT_EQ(measure.standardError, 0.0);
    }
}

/// Two pixels by hand: R = 1 and 3 (mean 2), I = 1.5 and 2.
TEST(Compare, HasTheValuesOfTheDefinition) {
    LayeredImage reference = uniform(2, 1, 1.0F), image = uniform(2, 1, 1.5F);
    for (const char* name : {"R", "G", "B"}) {
        reference.layer(name)[1] = 3.0F;
        image.layer(name)[1] = 2.0F;
    }
    const Comparison result = compare(image, reference);
    EXPECT_NEAR(result.meanReference, 2.0, 1e-15);
    EXPECT_NEAR(result.rmse.value, std::sqrt((0.25 + 1.0) / 2.0), 1e-15);
    EXPECT_NEAR(result.relMse.value, 0.5 * (0.25 / (1.0 + 0.04) + 1.0 / (9.0 + 0.04)), 1e-15);
    EXPECT_NEAR(result.bias.value, -0.25, 1e-15);
    EXPECT_NEAR(result.relativeBias.value, -0.125, 1e-15);
    EXPECT_NEAR(result.mape.value, 0.5 * (0.5 / 1.02 + 1.0 / 3.02), 1e-15);
}

/// The same two pixels, relative to D = 2 and 4 (mean 3), by one reference and by two that lie .5 to either side of it.
TEST(Compare, DividesByAnotherPictureWhereThereIsOne) {
    LayeredImage reference = uniform(2, 1, 1.0F), image = uniform(2, 1, 1.5F), denominator = uniform(2, 1, 2.0F);
    LayeredImage below = reference, above = reference;
    for (const char* name : {"R", "G", "B"}) {
        reference.layer(name)[1] = 3.0F;
        image.layer(name)[1] = 2.0F;
        denominator.layer(name)[1] = 4.0F;
        below.layer(name) = {0.5F, 2.5F};
        above.layer(name) = {1.5F, 3.5F};
    }
    const Comparison one = compare(image, reference, &denominator);
    EXPECT_NEAR(one.relMse.value, 0.5 * (0.25 / (4.0 + 0.09) + 1.0 / (16.0 + 0.09)), 1e-15);
    EXPECT_NEAR(one.mape.value, 0.5 * (0.5 / 2.03 + 1.0 / 4.03), 1e-15);
    EXPECT_NEAR(one.rmse.value, std::sqrt((0.25 + 1.0) / 2.0), 1e-15);
    EXPECT_NEAR(one.relativeBias.value, -0.125, 1e-15);
    // (1.5 − .5)(1.5 − 1.5) = 0 and (2 − 2.5)(2 − 3.5) = .75
    const Comparison two = compare(image, below, above, &denominator);
    EXPECT_NEAR(two.relMse.value, 0.5 * (0.75 / (16.0 + 0.09)), 1e-15);

    for (const char* name : {"transmittance.R", "transmittance.G", "transmittance.B"}) {
        reference.layer(name, 1.0F)[1] = 0.5F;
        denominator.layer(name, 1.0F)[0] = 0.5F;
    }
    EXPECT_NEAR(compare(image, reference, &denominator).bias.value, 0.5, 1e-15);
}

TEST(Compare, LooksOnlyAtTheCloudAndNotAtTheSun) {
    LayeredImage reference = uniform(3, 1, 1.0F), image = uniform(3, 1, 1.0F);
    for (const char* name : {"transmittance.R", "transmittance.G", "transmittance.B"}) {
        reference.layer(name, 0.5F)[0] = 0.9995F;
    }
    reference.layer("sun.disc")[2] = 0.1F;
    for (const char* name : {"R", "G", "B"}) image.layer(name) = {7.0F, 1.25F, 9.0F};
    const Comparison result = compare(image, reference);
    EXPECT_EQ(result.pixels, 1U);
    EXPECT_NEAR(result.bias.value, 0.25, 1e-15);

    reference.layer("transmittance.R")[1] = 1.0F;
    reference.layer("transmittance.G")[1] = 1.0F;
    reference.layer("transmittance.B")[1] = 1.0F;
    EXPECT_THROW(compare(image, reference), InputError);
}

/// The standard errors of the measures against their spread over noisy pictures. A channel's noise is the pixel's.
TEST(Compare, KnowsItsStandardErrors) {
    constexpr int side = 24, pictures = 400;
    constexpr float deviation = 0.05F, offset = 0.1F;
    std::mt19937 generator(11);
    std::normal_distribution<float> normal(0.0F, deviation);
    const LayeredImage reference = uniform(side, side, 1.0F);
    struct Spread {
        double mean = 0.0, square = 0.0, predicted = 0.0;
        void add(const Measure& m) {
            mean += m.value / pictures;
            square += m.value * m.value / pictures;
            predicted += *m.standardError / pictures;
        }
        double ratio() const { return predicted / std::sqrt(square - mean * mean); }
    } bias, relMse, rmse;
    double imageNoise = 0.0;
    for (int k = 0; k < pictures; ++k) {
        LayeredImage image = uniform(side, side, 1.0F + offset);
        for (std::size_t i = 0; i < image.pixels(); ++i) {
            const float noise = normal(generator);
            for (const char* name : {"R", "G", "B"}) image.layer(name)[i] += noise;
        }
        addVariance(image, deviation * deviation);
        const Comparison result = compare(image, reference);
        bias.add(result.bias);
        relMse.add(result.relMse);
        rmse.add(result.rmse);
        imageNoise = *result.imageNoise;
        EXPECT_FALSE(result.referenceNoise.has_value());
    }
    // the spread of 400 pictures is known to 3.5 %
    EXPECT_NEAR(bias.ratio(), 1.0, 0.14);
    EXPECT_NEAR(relMse.ratio(), 1.0, 0.14);
    EXPECT_NEAR(rmse.ratio(), 1.0, 0.14);
    EXPECT_NEAR(imageNoise, 0.0025 / 1.01, 1e-6);
    EXPECT_NEAR(relMse.mean, (0.01 + 0.0025) / 1.01, 4.0 * relMse.predicted / std::sqrt(pictures));
}

/// Two noisy references: the product form sees the picture's own error, and not their noise.
TEST(Compare, IsFreeOfTheNoiseOfTwoReferences) {
    std::mt19937 generator(12);
    std::normal_distribution<float> normal(0.0F, 0.2F);
    LayeredImage a = uniform(200, 200, 1.0F), b = a;
    for (LayeredImage* reference : {&a, &b}) {
        for (std::size_t i = 0; i < a.pixels(); ++i) {
            const float noise = normal(generator);
            for (const char* name : {"R", "G", "B"}) reference->layer(name)[i] += noise;
        }
        addVariance(*reference, 0.04F);
    }
    const LayeredImage image = uniform(200, 200, 1.1F);
    const Comparison one = compare(image, a), two = compare(image, a, b);
    EXPECT_GT(one.rmse.value, 0.2);
    EXPECT_NEAR(two.rmse.value, 0.1, 4.0 * *two.rmse.standardError);
    EXPECT_LT(*two.rmse.standardError, 0.01);
    EXPECT_NEAR(two.bias.value, 0.1, 4.0 * *two.bias.standardError);
    EXPECT_NEAR(*two.referenceNoise, *one.referenceNoise / 2.0, 0.1 * *one.referenceNoise);
}

std::string refusal(const LayeredImage& image, const LayeredImage& reference) {
    try {
        requireComparable({image, "a.exr"}, {reference, "b.exr"});
    } catch (const InputError& e) {
        return e.what();
    }
    return "";
}

TEST(Comparable, RefusesDifferentSizes) {
    EXPECT_EQ(refusal(uniform(4, 3, 1.0F), uniform(4, 3, 2.0F)), "");
    EXPECT_THAT(refusal(uniform(4, 3, 1.0F), uniform(3, 4, 1.0F)), HasSubstr("4×3 against 3×4"));
}

TEST(Comparable, SaysWhereThereIsNoNumber) {
    LayeredImage image = uniform(5, 4, 1.0F);
    image.layer("G")[5 * 2 + 3] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THAT(refusal(image, uniform(5, 4, 1.0F)),
                testing::AllOf(HasSubstr("layer G"), HasSubstr("x 3, y 2"), HasSubstr("a.exr")));
    LayeredImage reference = uniform(5, 4, 1.0F);
    addVariance(reference, 0.1F);
    reference.layer("variance.B")[0] = std::numeric_limits<float>::infinity();
    EXPECT_THAT(refusal(uniform(5, 4, 1.0F), reference), testing::AllOf(HasSubstr("variance.B"), HasSubstr("b.exr")));
}

TEST(Comparable, RefusesNegativeVariance) {
    LayeredImage image = uniform(5, 4, 1.0F);
    image.layer("variance.G", 0.0F)[7] = -1e-9F;
    EXPECT_THAT(refusal(image, uniform(5, 4, 1.0F)), HasSubstr("variance.G is below 0 at x 2, y 1"));
    image.layers.erase("variance.G");
    image.layer("sun.disc")[0] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THAT(refusal(uniform(5, 4, 1.0F), image), HasSubstr("sun.disc is not a finite number"));
}

TEST(Comparable, WantsColours) {
    LayeredImage image = uniform(2, 2, 1.0F);
    image.layers.erase("G");
    EXPECT_THAT(refusal(image, uniform(2, 2, 1.0F)), HasSubstr("no layer G"));
}

TEST(DifferencePicture, IsWhiteBlueAndRed) {
    const LayeredImage reference = uniform(3, 1, 1.0F);
    LayeredImage image = uniform(3, 1, 1.0F);
    for (const char* name : {"R", "G", "B"}) image.layer(name) = {1.0F, 0.9596F, 9.0F};
    const std::vector<std::uint8_t> rgb = differencePicture(image, reference);
    // 4 % too dark: a fifth towards blue
    EXPECT_THAT(rgb, testing::ElementsAre(255, 255, 255, 204, 204, 255, 255, 0, 0));
}

}  // namespace
}  // namespace lumulus::reference
