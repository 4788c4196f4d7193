#pragma once

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <cstddef>
#include <vector>

/// Values of other distributions as standard deviations of the normal one, so that all bounds are in these.
namespace lumulus::test {

/// The normal deviate that is as unlikely as a value of a distribution; infinite where its probability is below 1e-308.
template <class Distribution>
double normalDeviation(const Distribution& distribution, double value) {
    const boost::math::normal standard;
    const bool upper = value > median(distribution);  // the shorter tail, where probabilities keep their digits
    const double tail = upper ? cdf(complement(distribution, value)) : cdf(distribution, value);
    if (tail == 0.0) return upper ? INFINITY : -INFINITY;
    return upper ? quantile(complement(standard, tail)) : quantile(standard, tail);
}

/// A value t of Student's distribution: for errors that are estimated from a few values.
inline double studentDeviation(double t, double freedom) {
    return normalDeviation(boost::math::students_t(freedom), t);
}

/// Pearson's χ² of counts against expected counts. Neighbouring bins are joined until each expects at least 20.
/// `fitted` degrees of freedom go off for the total that both share.
inline double chiSquareDeviation(const std::vector<double>& observed, const std::vector<double>& expected,
                                 int fitted = 1) {
    double statistic = 0.0;
    double freedom = -fitted;
    double seen = 0.0;
    double due = 0.0;
    for (std::size_t i = 0; i < observed.size(); ++i) {
        seen += observed[i];
        due += expected[i];
        if (due >= 20.0 || (i + 1 == observed.size() && due > 0.0)) {
            statistic += (seen - due) * (seen - due) / due;
            freedom += 1.0;
            seen = 0.0;
            due = 0.0;
        }
    }
    if (seen > 0.0 || freedom < 1.0) return INFINITY;  // samples where none can be, or nothing to compare
    return normalDeviation(boost::math::chi_squared(freedom), statistic);
}

}  // namespace lumulus::test
