// The two codes of Mie's theory, which share nothing, against each other.
#include "reference/droplets.h"

#include <gtest/gtest.h>

#include <cmath>

#include "medium/mie.h"
#include "reference/phase.h"
#include "support/phase_cases.h"

namespace lumulus {
namespace {

TEST(Droplets, TheReferenceAgrees) {
    constexpr double radius = 6.0, variance = 0.1;
    const auto colours = phase::mieColours(radius, variance);
    const reference::Droplets own = reference::makeDroplets(radius, variance);
    ASSERT_EQ(own.colours.size(), 4U);
    double squares = 0.0;
    int count = 0;
    for (double angle = 0.0; angle <= 180.0; angle += angle < 3.0 || angle > 170.0 ? 0.1 : 0.5) {
        const double x = test::oneMinusCosine(angle * test::degree);
        for (std::size_t c = 0; c < 4; ++c) {
            const phase::TabulatedPhase& table = c < 3 ? colours.channels[c] : colours.mean.front();
            const double ratio = own.colours[c].evaluate(x) / table.evaluate(angle * test::degree);
            EXPECT_NEAR(ratio, 1.0, 0.12) << angle << " " << c;  // narrow resonances are noise of both
            squares += (ratio - 1.0) * (ratio - 1.0);
            ++count;
        }
    }
    EXPECT_LT(std::sqrt(squares / count), 0.02);
}

TEST(Droplets, TheReferenceSamplesWhatItEvaluates) {
    scene::Phase phase;
    phase.model = scene::PhaseModel::mie;
    phase.effectiveRadius = 6.0;
    const reference::PhaseFunction p(phase);
    EXPECT_TRUE(p.coloured());
    // p over the sphere, and the mean cosine by both
    double whole = 0.0, cosine = 0.0;
    constexpr int steps = 400000;
    for (int i = 0; i < steps; ++i) {
        const double theta = test::pi * (i + 0.5) / steps, x = test::oneMinusCosine(theta);
        const double weight = 2.0 * test::pi * test::pi / steps * std::sin(theta) * p.evaluate(x);
        whole += weight;
        cosine += (1.0 - x) * weight;
    }
    EXPECT_NEAR(whole, 1.0, 1e-5);
    reference::Random random(3, 0, 0);
    double sum = 0.0, squares = 0.0;
    constexpr int samples = 200000;
    for (int i = 0; i < samples; ++i) {
        const double c = 1.0 - p.sample(random);
        sum += c;
        squares += c * c;
    }
    const double mean = sum / samples, error = std::sqrt((squares / samples - mean * mean) / samples);
    EXPECT_NEAR(mean, cosine, 4.0 * error);
    // colours are about their mean by luminance of sunlight
    const glm::dvec3 weights = glm::dvec3(0.2126 * 210.45, 0.7152 * 189.23, 0.0722 * 185.23);
    for (const double angle : {10.0, 141.0, 178.0}) {
        const double luminance = glm::dot(weights, p.hue(test::oneMinusCosine(angle * test::degree)));
        EXPECT_NEAR(luminance / (weights.x + weights.y + weights.z), 1.0, 1e-6);
    }
}

}  // namespace
}  // namespace lumulus
