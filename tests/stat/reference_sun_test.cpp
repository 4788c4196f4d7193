#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "reference/aureole.h"
#include "reference/tracer.h"
#include "stat/ball.h"
#include "support/deviation.h"
#include "support/statistics.h"

namespace lumulus::reference {
namespace {

using glm::dvec3;
using test::RunningMean;

constexpr double ballRadius = 10.0;

/// A white ball under a sun of irradiance 1 and this diameter in degrees, 12° beside where `rayBeside` goes.
scene::Scene ballScene(double tau, double g, double diameter) {
    scene::Scene scene;
    scene.clouds.resize(1);
    scene.clouds[0].extinction = tau / (2.0 * ballRadius);
    scene.clouds[0].phase.g = g;
    scene.sun.irradiance = dvec3(1.0);
    scene.sun.directionTo = dvec3(std::sin(glm::radians(12.0)), 0.0, -std::cos(glm::radians(12.0)));
    scene.sun.angularDiameter = diameter;
    scene.sky.radiance = dvec3(0.0);
    return scene;
}

/// From +Z, `b` beside the middle of the ball.
Ray rayBeside(double b) {
    return {{b, 0.0, 50.0}, {0.0, 0.0, -1.0}};
}

/// The same light by chance alone: a path turns as the phase function has it until it escapes, into the disc or not. No
/// shadow rays, no weights, no branches, no roulette.
double byChance(const scene::Scene& scene, const Medium& medium, const MajorantGrid& majorants, const Ray& start,
                Random& random) {
    const PhaseFunction phase(scene.clouds[0].phase);
    Ray ray = start;
    for (bool scattered = false;; scattered = true) {
        const VoxelRay voxel = medium.toVoxel(ray);
        const std::optional<Interval> inside = medium.clip(voxel);
        std::optional<double> collision;
        if (inside) {
            majorants.walk(voxel, *inside, random, [&](double t, double majorant) {
                if (random.uniform() * majorant < medium.extinctionScale() * medium.density(voxel.at(t))) collision = t;
                return collision.has_value();
            });
        }
        if (!collision) {
            const double radius = glm::radians(0.5 * scene.sun.angularDiameter);
            const bool hit = oneMinusCosBetween(ray.direction, scene.sun.directionTo) < 1.0 - std::cos(radius);
            return scattered && hit ? 1.0 / (glm::pi<double>() * std::pow(std::sin(radius), 2)) : 0.0;
        }
        ray.origin += *collision * ray.direction;
        ray.direction = turned(ray.direction, phase.sample(random), random);
    }
}

struct Case {
    const char* name;
    double g, diameter;
};

class SunThroughABall : public testing::TestWithParam<Case> {};

/// Shadow rays, escapes into the disc and branches to the aureole add up to what escapes alone find.
TEST_P(SunThroughABall, AgreesWithEscapesAlone) {
    const scene::Scene scene = ballScene(4.0, GetParam().g, GetParam().diameter);
    const vdb::Volume ball = ballVolume(18, ballRadius);
    const PathTracer tracer(scene, {ball}, Majorant::local);
    const Medium medium(ball, scene.clouds[0].extinction);
    const MajorantGrid majorants(medium, Majorant::local);
    Random random(21, 0, 0);
    RunningMean weighted, chance;
    for (int i = 0; i < 100'000; ++i) weighted.add(tracer.trace(rayBeside(2.0), random).radiance.y);
    for (int i = 0; i < 600'000; ++i) chance.add(byChance(scene, medium, majorants, rayBeside(2.0), random));
    EXPECT_NEAR(weighted.mean(), chance.mean(), 4.0 * std::hypot(weighted.standardError(), chance.standardError()));
    EXPECT_LT(chance.standardError(), 0.02 * chance.mean());
    EXPECT_LT(weighted.standardError(), 0.02 * weighted.mean());
}

INSTANTIATE_TEST_SUITE_P(Lobes, SunThroughABall,
                         testing::Values(Case{"WideLobeWideSun", 0.6, 30.0}, Case{"NarrowLobeWideSun", 0.99, 10.0},
                                         Case{"LobeAsWideAsTheSun", 0.95, 6.0}, Case{"WideLobeNarrowSun", 0.85, 6.0},
                                         Case{"BackwardLobeWideSun", -0.95, 20.0}),
                         [](const testing::TestParamInfo<Case>& row) { return std::string(row.param.name); });

scene::Phase phaseOf(scene::PhaseModel model, double g, double diameter) {
    scene::Phase phase;
    phase.model = model;
    phase.g = g;
    phase.dropletDiameter = diameter;
    return phase;
}

/// The lobe is as high as the phase function, if that is narrow and wider than the sun.
TEST(Aureole, HasThePeakOfThePhaseFunction) {
    const dvec3 sun = glm::normalize(dvec3(1.0, 2.0, -0.5));
    for (const scene::Phase& phase :
         {phaseOf(scene::PhaseModel::henyeyGreenstein, 0.95, 20.0),
          phaseOf(scene::PhaseModel::henyeyGreenstein, 0.9999, 20.0), phaseOf(scene::PhaseModel::schlick, 0.93, 20.0),
          phaseOf(scene::PhaseModel::droplet, 0.0, 20.0)}) {
        const PhaseFunction function(phase);
        const std::optional<Aureole> aureole = Aureole::of(function, sun, 0.0);
        ASSERT_TRUE(aureole);
        EXPECT_NEAR(aureole->density(sun) / function.evaluate(0.0), 1.0, 1e-9);
        EXPECT_NEAR(aureole->importance(sun), 1.0 + 4.0 * glm::pi<double>() * aureole->density(sun), 1e-9);
        const std::optional<Aureole> ofAWideSun = Aureole::of(function, sun, 0.08);
        ASSERT_TRUE(ofAWideSun);
        EXPECT_NEAR(ofAWideSun->density(sun), 1.92 / (4.0 * glm::pi<double>() * 0.0064), 1e-9);
    }
    EXPECT_FALSE(Aureole::of(PhaseFunction(phaseOf(scene::PhaseModel::henyeyGreenstein, 0.85, 20.0)), sun, 0.0));
    EXPECT_FALSE(Aureole::of(PhaseFunction(phaseOf(scene::PhaseModel::henyeyGreenstein, 0.99, 20.0)), sun, 0.5));
}

/// Where light goes to and fro there are two lobes, of half the peak each.
TEST(Aureole, HasALobeOnEitherSideWhereLightReturns) {
    const dvec3 sun = glm::normalize(dvec3(1.0, 2.0, -0.5));
    const PhaseFunction function(phaseOf(scene::PhaseModel::henyeyGreenstein, -0.95, 20.0));
    const std::optional<Aureole> aureole = Aureole::of(function, sun, 0.0);
    ASSERT_TRUE(aureole);
    EXPECT_NEAR(aureole->density(sun) / function.evaluate(2.0), 0.5, 1e-4);
    EXPECT_NEAR(aureole->density(-sun), aureole->density(sun), 1e-9);
    Random random(23, 0, 0);
    constexpr int samples = 100'000;
    int near = 0;
    for (int i = 0; i < samples; ++i) near += glm::dot(aureole->sample(random), sun) > 0.0 ? 1 : 0;
    EXPECT_NEAR(near, samples / 2, 4.0 * std::sqrt(samples / 4.0));
}

/// Branches are drawn as densely as `density` says, about the sun: a χ² test over 30 bins of 1 − cos.
TEST(Aureole, BranchesGoWhereTheDensitySays) {
    const dvec3 sun = glm::normalize(dvec3(-0.3, 0.4, 0.8));
    const std::optional<Aureole> aureole =
        Aureole::of(PhaseFunction(phaseOf(scene::PhaseModel::droplet, 0.0, 20.0)), sun, 0.0);
    ASSERT_TRUE(aureole);
    constexpr int bins = 30, samples = 100'000, steps = 400;
    const auto edge = [](int i) { return i == 0 ? 0.0 : 2.0 * std::pow(1e-6, 1.0 - static_cast<double>(i) / bins); };
    std::vector<double> observed(bins), expected(bins);
    Random random(22, 0, 0);
    for (int i = 0; i < samples; ++i) {
        const double x = oneMinusCosBetween(sun, aureole->sample(random));
        int at = 0;
        while (at + 1 < bins && x >= edge(at + 1)) ++at;
        observed[static_cast<std::size_t>(at)] += 1.0;
    }
    for (int i = 0; i < bins; ++i) {
        for (int k = 0; k < steps; ++k) {
            const double x = edge(i) + (edge(i + 1) - edge(i)) * (k + 0.5) / steps;
            const dvec3 direction = turned(sun, x, random);
            expected[static_cast<std::size_t>(i)] +=
                samples * 2.0 * glm::pi<double>() * aureole->density(direction) * (edge(i + 1) - edge(i)) / steps;
        }
    }
    EXPECT_LT(test::chiSquareDeviation(observed, expected), 4.0);
}

}  // namespace
}  // namespace lumulus::reference
