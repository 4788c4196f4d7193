#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "base/error.h"
#include "bench/plan.h"

namespace lumulus::bench {
namespace {

TEST(Cost, IsTheLineThroughTwoTimings) {
    const Cost cost = costFrom({1e5, 0.3}, {5e5, 1.1});
    EXPECT_NEAR(cost.perPhoton, 2e-6, 1e-15);
    EXPECT_NEAR(cost.fixed, 0.1, 1e-12);
}

TEST(Cost, OfNoisyTimingsStaysPositive) {
    for (const double less : {2.0, 0.01}) {  // falls; meets the axis below zero
        const Cost cost = costFrom({1e5, less}, {2e5, 1.0});
        EXPECT_EQ(cost.fixed, 0.0);
        EXPECT_NEAR(cost.perPhoton, 5e-6, 1e-15);
    }
}

TEST(Plan, FillsEachBudget) {
    const std::vector<double> budgets{0.3, 1.0, 3.0};
    const std::vector<PhotonBudget> plan = planPhotons(budgets, {0.1, 1e-6}, 1000);
    ASSERT_EQ(plan.size(), 3U);
    EXPECT_EQ(plan[0].photons, 200000);
    EXPECT_EQ(plan[1].photons, 900000);
    EXPECT_EQ(plan[2].photons, 2900000);
    EXPECT_EQ(plan[2].seconds, 3.0);
}

TEST(Plan, CountsBudgetsBelowTheFixedCostOnce) {
    const std::vector<double> budgets{0.01, 0.1, 0.5, 3.0};
    const std::vector<PhotonBudget> plan = planPhotons(budgets, {0.5, 1e-6}, 1000);
    ASSERT_EQ(plan.size(), 2U);
    EXPECT_EQ(plan[0].photons, 1000);
    EXPECT_EQ(plan[0].seconds, 0.01);
    EXPECT_EQ(plan[1].photons, 2500000);
}

TEST(Plan, StopsAtTheLimitOfSceneFiles) {
    const std::vector<double> budgets{1e6};
    EXPECT_EQ(planPhotons(budgets, {0.0, 1e-12}, 1000).front().photons, 1000000000000);
}

TEST(Budgets, RiseAndStandOnce) {
    EXPECT_EQ(orderedBudgets({3.0, 0.3, 1.0, 0.3}), (std::vector<double>{0.3, 1.0, 3.0}));
}

TEST(Budgets, RefuseWhatIsNoTime) {
    EXPECT_THROW(orderedBudgets({}), InputError);
    EXPECT_THROW(orderedBudgets({1.0, 0.0}), InputError);
    EXPECT_THROW(orderedBudgets({-1.0}), InputError);
    EXPECT_THROW(orderedBudgets({2e6}), InputError);
    EXPECT_THROW(orderedBudgets({std::numeric_limits<double>::quiet_NaN()}), InputError);
}

TEST(Seeds, LeaveOutTheReferencesOwn) {
    EXPECT_EQ(seedsWithout(1, 3, 1), (std::vector<std::uint64_t>{2, 3, 4}));
    EXPECT_EQ(seedsWithout(1, 3, 2), (std::vector<std::uint64_t>{1, 3, 4}));
    EXPECT_EQ(seedsWithout(5, 2, 1), (std::vector<std::uint64_t>{5, 6}));
    EXPECT_EQ(seedsWithout(5, 2, std::nullopt), (std::vector<std::uint64_t>{5, 6}));
}

}  // namespace
}  // namespace lumulus::bench
