// The bounds of all statistical tests, at values that tables of the distributions have.
#include "support/deviation.h"

#include <gtest/gtest.h>

namespace lumulus::test {
namespace {

TEST(Deviation, OfStudentsDistribution) {
    // one-sided probabilities of 0.025 and 0.0005: 1.9600 and 3.2905 of the normal distribution
    EXPECT_NEAR(studentDeviation(2.042272, 30.0), 1.959964, 1e-5);
    EXPECT_NEAR(studentDeviation(-2.570582, 5.0), -1.959964, 1e-5);
    EXPECT_NEAR(studentDeviation(6.868827, 5.0), 3.290527, 1e-5);
    EXPECT_EQ(studentDeviation(0.0, 3.0), 0.0);
}

TEST(Deviation, OfFarValuesStaysOrdered) {
    EXPECT_GT(studentDeviation(1e3, 31.0), 10.0);
    EXPECT_LT(studentDeviation(-1e3, 31.0), -10.0);
    EXPECT_EQ(studentDeviation(1e300, 31.0), INFINITY);
}

/// Counts in `bins` bins that expect 100 each, two of which are off by `off`.
double deviationOf(std::size_t bins, double off) {
    std::vector<double> observed(bins, 100.0);
    observed.front() += off;
    observed.back() -= off;
    return chiSquareDeviation(observed, std::vector<double>(bins, 100.0));
}

TEST(Deviation, OfChiSquare) {
    // χ² of 10 degrees of freedom: above 18.3070 with a probability of 0.05, below 3.94030 with one of 0.05
    EXPECT_NEAR(deviationOf(11, std::sqrt(18.30704 * 50.0)), 1.644854, 1e-5);
    EXPECT_NEAR(deviationOf(11, std::sqrt(3.940299 * 50.0)), -1.644854, 1e-5);
    EXPECT_EQ(deviationOf(11, 0.0), -INFINITY);
}

TEST(Deviation, OfChiSquareJoinsThinBins) {
    // four bins that expect 10 are two that expect 20: one degree of freedom, χ² = 2 · 10²/20
    const std::vector<double> expected(4, 10.0);
    EXPECT_NEAR(chiSquareDeviation({15.0, 15.0, 5.0, 5.0}, expected),
                normalDeviation(boost::math::chi_squared(1), 10.0), 1e-12);
    EXPECT_NEAR(chiSquareDeviation({15.0, 15.0, 5.0, 5.0}, expected), 2.954594, 1e-5);  // probability 0.0015654
    EXPECT_EQ(chiSquareDeviation({20.0, 1.0}, {20.0, 0.0}), INFINITY);
}

}  // namespace
}  // namespace lumulus::test
