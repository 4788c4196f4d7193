// Rings about the sun's axis, which stand for the bands above those of a collector.
#include "medium/sun_axis.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "medium/axes.h"
#include "medium/scattering_tables.h"
#include "shared/phase_table.h"
#include "shared/sun_axis.h"
#include "support/phase_cases.h"

namespace lumulus::phase {
namespace {

using test::degree;
using test::pi;

constexpr std::size_t rings = shared::AXIS_RINGS;
constexpr std::size_t angles = shared::singleScatterAngleCount;

scene::Phase backward(double g) {
    return {scene::PhaseModel::henyeyGreenstein, g, 20.0};
}

/// What a ring scatters, at entry `i` of the angle axis.
double entry(const ScatteringTables& tables, std::size_t ring, std::size_t i) {
    return static_cast<double>(tables.axisTable[ring * angles + i]);
}

ScatteringTables tablesOf(const scene::Phase& phase) {
    return makeScatteringTables(phase, 15.0 * degree, glm::dvec3(1.0), 4, 0.53 * degree);
}

TEST(SunAxis, OnlyBackwardPeaksNeedRings) {
    for (const double g : {-0.3, 0.0, 0.5, 0.85, 0.99}) EXPECT_FALSE(hasBackwardPeak(PhaseFunction(backward(g)))) << g;
    for (const double g : {-0.7, -0.95, -0.999}) EXPECT_TRUE(hasBackwardPeak(PhaseFunction(backward(g)))) << g;
    EXPECT_TRUE(hasBackwardPeak(PhaseFunction({scene::PhaseModel::schlick, -0.9, 20.0})));
    for (const scene::PhaseModel model :
         {scene::PhaseModel::rayleigh, scene::PhaseModel::hazy, scene::PhaseModel::murky, scene::PhaseModel::droplet})
        EXPECT_FALSE(hasBackwardPeak(PhaseFunction({model, 0.0, 10.0})));
    EXPECT_TRUE(tablesOf(backward(0.85)).axisTable.empty());
}

/// A chord is in the ring between whose edges it lies; the last one ends at a right angle.
TEST(SunAxis, RingsTileTheHemisphere) {
    for (int ring = 0; ring < shared::AXIS_RINGS; ++ring) {
        const float begin = shared::axisRingEdge(ring), end = shared::axisRingEdge(ring + 1);
        EXPECT_LT(begin, end);
        EXPECT_EQ(shared::axisRing(0.5F * (begin + end)), ring);
        EXPECT_EQ(shared::axisRing(1.001F * begin + 1e-6F), ring);
    }
    EXPECT_FLOAT_EQ(shared::axisRingEdge(shared::AXIS_RINGS), std::sqrt(2.0F));
}

/// Light that comes from all sides alike has no bands above the first, whatever the direction.
TEST(SunAxis, IsotropicLightHasNothingInTheBandsAbove) {
    for (const double g : {-0.8, -0.95, -0.99}) {
        const ScatteringTables tables = tablesOf(backward(g));
        for (std::size_t i = 0; i < angles; i += 7) {
            double sum = 0.0;
            for (std::size_t ring = 0; ring < rings; ++ring) {
                const auto begin = static_cast<double>(shared::axisRingEdge(static_cast<int>(ring)));
                const auto end = static_cast<double>(shared::axisRingEdge(static_cast<int>(ring) + 1));
                // solid angle: π (end² − begin²); the axis is symmetric, so that the other end sees the mirrored angle
                sum +=
                    pi * (end * end - begin * begin) * (entry(tables, ring, i) + entry(tables, ring, angles - 1 - i));
            }
            EXPECT_NEAR(sum, 0.0, 2e-3) << g << " " << i;
        }
    }
}

/// With the bands of a collector, light along the axis itself is scattered by the phase function.
TEST(SunAxis, TheInnermostRingAndTheBandsAreThePhaseFunction) {
    const scene::Phase phase = backward(-0.8);
    const PhaseFunction function(phase);
    const ScatteringTables tables = tablesOf(phase);
    const std::vector<double> moments = function.moments(3);
    EXPECT_EQ(tables.bandMoments[3], 0.0F) << "left to the rings";
    for (std::size_t i = 0; i < angles; i += 5) {
        const double theta = axisToAngle(static_cast<double>(i) / static_cast<double>(angles - 1),
                                         static_cast<double>(tables.angleScale));
        double whole = entry(tables, 0, i);
        for (unsigned l = 0; l < 3; ++l)
            whole += (2.0 * l + 1.0) / (4.0 * pi) * moments[l] * std::legendre(l, std::cos(theta));
        const double exact = function.evaluateAngle(theta);
        EXPECT_NEAR(whole, exact, 2e-3 * exact + 1e-6) << theta;
    }
}

}  // namespace
}  // namespace lumulus::phase
