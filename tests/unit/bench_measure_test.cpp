#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "base/error.h"
#include "bench/measure.h"

namespace lumulus::bench {
namespace {

LayeredImage grey(float value) {
    LayeredImage image;
    image.width = 4;
    image.height = 3;
    for (const char* channel : {"R", "G", "B"}) image.layer(channel, value);
    return image;
}

LayeredImage greyWithVariance(float value, float variance) {
    LayeredImage image = grey(value);
    for (const char* channel : {"variance.R", "variance.G", "variance.B"}) image.layer(channel, variance);
    return image;
}

TEST(Measure, AgainstAReferenceWithoutNoise) {
    const Truth truth = makeTruth(grey(1.0F), "truth.exr", 4, 3, 0.0);
    EXPECT_FALSE(truth.floor.has_value());
    const Errors errors = measure(grey(1.5F), truth);
    EXPECT_NEAR(errors.relMse, 0.25 / 1.01, 1e-12);
    EXPECT_NEAR(errors.rmse, 0.5, 1e-12);
    EXPECT_NEAR(errors.bias, 0.5, 1e-12);
    EXPECT_NEAR(errors.relativeBias, 0.5, 1e-12);
    EXPECT_GT(errors.flip, 0.0);
}

TEST(Measure, SubtractsTheNoiseOfTheReference) {
    const Truth truth = makeTruth(greyWithVariance(1.0F, 0.0625F), "truth.exr", 4, 3, 0.0);
    ASSERT_TRUE(truth.floor.has_value());
    EXPECT_NEAR(*truth.floor, 0.0625 / 1.01, 1e-12);
    EXPECT_NEAR(measure(grey(1.5F), truth).relMse, (0.25 - 0.0625) / 1.01, 1e-12);
}

TEST(Measure, RefusesAnotherSizeAndSaysHowToMend) {
    try {
        makeTruth(grey(1.0F), "truth.exr", 8, 3, 0.0);
        FAIL() << "a reference of another size passed";
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), testing::HasSubstr("4×3"));
        EXPECT_THAT(e.what(), testing::HasSubstr("--set image.width=4 --set image.height=3"));
    }
}

TEST(Measure, RefusesNaN) {
    LayeredImage bad = grey(1.0F);
    bad.layers.at("G")[5] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(makeTruth(bad, "truth.exr", 4, 3, 0.0), InputError);
}

TEST(Measure, RefusesABlackReference) {
    EXPECT_THROW(makeTruth(grey(0.0F), "truth.exr", 4, 3, 0.0), InputError);
}

}  // namespace
}  // namespace lumulus::bench
