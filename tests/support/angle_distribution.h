#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "medium/axes.h"
#include "medium/phase_function.h"
#include "shared/phase.h"
#include "support/deviation.h"
#include "support/phase_cases.h"
#include "support/statistics.h"

namespace lumulus::test {

/// θ from the chords, precise at both poles.
inline double thetaOf(const shared::ScatterAngle& angle) {
    return 2.0 * std::atan2(std::sqrt(static_cast<double>(angle.oneMinusCos)),
                            std::sqrt(static_cast<double>(angle.onePlusCos)));
}

/// Collects sampled angles and compares them with p restricted to θ ≥ cut: every angle is possible, χ² of 200 bins that
/// resolve lobes at both poles, and the mean of 1 − cos θ, all within 5 standard deviations.
class AngleDistribution {
  public:
    AngleDistribution(const phase::PhaseFunction& p, double cut) : phase_(p), cut_(cut), counts_(bins, 0.0) {
        for (int i = 0; i <= bins; ++i) {
            edges_.push_back(phase::axisToAngle(static_cast<double>(i) / bins, p.lobeWidth()));
        }
    }

    void add(const shared::ScatterAngle& angle) {
        // never below the cut, to the rounding of a float near 1
        const double least = oneMinusCosine(cut_) * (1.0 - 1e-5) - (cut_ > 0.0 ? 2e-7 : 0.0);
        const bool possible =
            angle.oneMinusCos >= 0.0F && angle.oneMinusCos <= 2.0F && angle.onePlusCos >= 0.0F &&
            angle.onePlusCos <= 2.0F && std::abs(angle.oneMinusCos + angle.onePlusCos - 2.0F) <= 1e-6F &&
            std::abs(angle.sinTheta * angle.sinTheta - angle.oneMinusCos * angle.onePlusCos) <= 1e-6F &&
            static_cast<double>(angle.oneMinusCos) >= least;
        impossible_ += possible ? 0 : 1;
        const double theta = std::max(thetaOf(angle), cut_);
        const auto bin = std::upper_bound(edges_.begin(), edges_.end(), theta) - edges_.begin() - 1;
        counts_[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(bin, 0, bins - 1))] += 1.0;
        oneMinusCos_.add(static_cast<double>(angle.oneMinusCos));
    }

    void expectAgreement() const {
        constexpr double deviations = 5.0;
        const double width = phase_.lobeWidth();
        const auto density = [this](double theta) { return phase_.evaluateAngle(theta); };
        const double turn = integrateSphere(density, cut_, pi, width);
        double samples = 0.0;
        for (const double count : counts_) {
            samples += count;
        }
        std::vector<double> expected;
        for (std::size_t i = 0; i < bins; ++i) {
            const double begin = std::max(edges_[i], cut_);
            const double mass = edges_[i + 1] > begin ? integrateSphere(density, begin, edges_[i + 1], width) : 0.0;
            expected.push_back(samples * mass / turn);
        }
        const double mean =
            integrateSphere([&](double theta) { return density(theta) * oneMinusCosine(theta); }, cut_, pi, width) /
            turn;
        EXPECT_EQ(impossible_, 0) << "angles out of range";
        EXPECT_LT(std::abs(chiSquareDeviation(counts_, expected)), deviations);
        EXPECT_NEAR(oneMinusCos_.mean(), mean, deviations * oneMinusCos_.standardError() + 1e-7);
    }

    const RunningMean& oneMinusCos() const { return oneMinusCos_; }

  private:
    static constexpr int bins = 200;

    phase::PhaseFunction phase_;
    double cut_;
    std::vector<double> edges_;
    std::vector<double> counts_;
    RunningMean oneMinusCos_;
    int impossible_ = 0;
};

}  // namespace lumulus::test
