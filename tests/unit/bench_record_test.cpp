#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "bench/record.h"
#include "bench/table.h"

namespace lumulus::bench {
namespace {

using testing::HasSubstr;

using Runs = std::vector<Run>;  // in a test, Run is a function of GoogleTest

Run run(Method method, double budget, double relMse) {
    return {method, budget, 2.0 * budget, budget, 1e6 * budget, {relMse, 0.2, 0.05, -0.01, -0.02}};
}

/// render: .1 / seconds; path tracer: 4 / seconds, twice each with a spread.
std::vector<Row> twoMethods() {
    Runs runs;
    for (const double seconds : {1.0, 10.0, 100.0}) {
        for (const double share : {0.9, 1.1}) {
            runs.push_back(run(Method::render, seconds, share * 0.1 / seconds));
            runs.push_back(run(Method::pathTracer, seconds, share * 4.0 / seconds));
        }
    }
    return summarise(runs);
}

TEST(Rows, AreMeanAndDeviationOverTheSeeds) {
    const std::vector<Row> rows = summarise(
        Runs{run(Method::render, 1.0, 0.1), run(Method::pathTracer, 1.0, 0.5), run(Method::render, 1.0, 0.3)});
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_EQ(rows[0].method, Method::render);
    EXPECT_EQ(rows[0].seeds, 2U);
    EXPECT_NEAR(rows[0].relMse.mean, 0.2, 1e-15);
    EXPECT_NEAR(rows[0].relMse.deviation, 0.1414213562373095, 1e-12);  // √((.1² + .1²) / 1)
    EXPECT_EQ(rows[1].seeds, 1U);
    EXPECT_EQ(rows[1].relMse.deviation, 0.0);
}

TEST(Csv, IsOneLineARow) {
    const std::vector<Row> rows = summarise(
        Runs{run(Method::render, 1.0, 0.01), run(Method::render, 1.0, 0.03), run(Method::pathTracer, 3, 0.5)});
    EXPECT_EQ(csv(rows),
              "method,budget,seeds,seconds,seconds_spread,seconds_without_warmup,seconds_without_warmup_spread,"
              "photons_or_spp,photons_or_spp_spread,relMSE,relMSE_spread,RMSE,RMSE_spread,FLIP,FLIP_spread,"
              "bias,bias_spread,relative_bias,relative_bias_spread\n"
              "render,1,2,2,0,1,0,1e+06,0,0.02,0.0141,0.2,0,0.05,0,-0.01,0,-0.02,0\n"
              "path tracer,3,1,6,0,3,0,3e+06,0,0.5,0,0.2,0,0.05,0,-0.01,0,-0.02,0\n");
}

TEST(Table, GivesTimesAndTheirRatio) {
    const std::string text = tableText(twoMethods(), 2e-4);
    // 10 s and, beyond the last point (.04 at 100 s), 400 s; the other clock has the double for render, and 100 s more
    // for the path tracer, which it takes to load
    EXPECT_THAT(text, testing::ContainsRegex("relMSE 0.01 +without warm-up +10 s +~400 s +40\n"));
    EXPECT_THAT(text, testing::ContainsRegex("relMSE 0.01 +whole +20 s +~500 s +25\n"));
    EXPECT_THAT(text, testing::ContainsRegex("relMSE 0.003 +without warm-up +33.3 s +~1.33e\\+03 s +40\n"));
    EXPECT_THAT(text, HasSubstr("relMSE 0.0002, subtracted"));
}

TEST(Table, SaysWhatItDoesNotKnow) {
    const std::vector<Row> rows = summarise(Runs{run(Method::render, 1.0, 0.05), run(Method::pathTracer, 1.0, 0.005)});
    const std::string text = tableText(rows, std::nullopt);
    EXPECT_THAT(text, testing::ContainsRegex("relMSE 0.01 +without warm-up +not reached +≤ 1 s +-\n"));
    EXPECT_THAT(text, HasSubstr("reference noise: unknown"));
}

}  // namespace
}  // namespace lumulus::bench
