#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "bench/curve.h"

namespace lumulus::bench {
namespace {

TEST(TimeToError, IsInterpolatedOnLogarithmicPaper) {
    // error = .1 / seconds: a straight line there
    const std::vector<CurvePoint> curve{{1.0, 0.1}, {10.0, 0.01}, {100.0, 0.001}};
    for (const double target : {0.05, 0.02, 0.01, 0.003, 0.001}) {
        const TimeToError time = timeToReach(curve, target, std::nullopt);
        EXPECT_EQ(time.how, Reached::measured);
        EXPECT_NEAR(time.seconds, 0.1 / target, 1e-9);
    }
}

TEST(TimeToError, FollowsTheSlopeOfThePieceThatCrosses) {
    // slope -1/2 first, then -2: the crossing of .05 lies at 4 s · (.1/.05)^(1/2)
    const std::vector<CurvePoint> curve{{1.0, 0.2}, {4.0, 0.1}, {8.0, 0.025}};
    EXPECT_NEAR(timeToReach(curve, 0.05, std::nullopt).seconds, 4.0 * 1.4142135623730951, 1e-9);
}

TEST(TimeToError, TakesTheFirstCrossing) {
    const std::vector<CurvePoint> curve{{1.0, 0.1}, {2.0, 0.005}, {3.0, 0.02}, {4.0, 0.001}};
    const TimeToError time = timeToReach(curve, 0.01, std::nullopt);
    EXPECT_EQ(time.how, Reached::measured);
    EXPECT_GT(time.seconds, 1.0);
    EXPECT_LT(time.seconds, 2.0);
}

TEST(TimeToError, FirstPointIsABound) {
    const TimeToError time = timeToReach(std::vector<CurvePoint>{{0.5, 0.002}, {1.0, 0.001}}, 0.01, std::nullopt);
    EXPECT_EQ(time.how, Reached::atFirst);
    EXPECT_EQ(time.seconds, 0.5);
}

TEST(TimeToError, GoesOnWithTheSamplesOnlyWhereToldSo) {
    const std::vector<CurvePoint> curve{{1.0, 0.4}, {10.0, 0.04}};
    EXPECT_EQ(timeToReach(curve, 0.01, std::nullopt).how, Reached::never);
    const TimeToError time = timeToReach(curve, 0.01, 0.0);
    EXPECT_EQ(time.how, Reached::extrapolated);
    EXPECT_NEAR(time.seconds, 40.0, 1e-12);
    // 2 s of loading, 8 s of samples: four times the samples are 2 + 32 s
    EXPECT_NEAR(timeToReach(curve, 0.01, 2.0).seconds, 34.0, 1e-12);
}

TEST(TimeToError, BelowTheNoiseOfTheReferenceCountsAsReached) {
    const std::vector<CurvePoint> curve{{1.0, 0.1}, {3.0, -1e-4}};
    const TimeToError time = timeToReach(curve, 0.003, std::nullopt);
    EXPECT_EQ(time.how, Reached::measured);
    EXPECT_EQ(time.seconds, 3.0);
}

TEST(TimeToError, OfNothingIsNever) {
    EXPECT_EQ(timeToReach({}, 0.01, 0.0).how, Reached::never);
}

}  // namespace
}  // namespace lumulus::bench
