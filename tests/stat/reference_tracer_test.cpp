#include "reference/tracer.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "stat/ball.h"
#include "support/statistics.h"

namespace lumulus::reference {
namespace {

using glm::dvec3;
using test::RunningMean;

constexpr double ballRadius = 10.0;

/// A ball of optical thickness `tau` through its middle, without lights.
scene::Scene ballScene(double tau, double g) {
    scene::Scene scene;
    scene.clouds.resize(1);
    scene.clouds[0].extinction = tau / (2.0 * ballRadius);
    scene.clouds[0].phase.g = g;
    scene.sun.irradiance = dvec3(0.0);
    scene.sky.radiance = dvec3(0.0);
    return scene;
}

/// From +Z, `b` beside the middle of the ball.
Ray rayBeside(double b) {
    return {{b, 0.0, 50.0}, {0.0, 0.0, -1.0}};
}

TEST(RatioTracking, AgreesWithQuadrature) {
    const Medium medium(ballVolume(34, ballRadius), 4.0 / (2.0 * ballRadius));
    for (const Majorant kind : {Majorant::local, Majorant::global}) {
        const MajorantGrid grid(medium, kind);
        for (const double threshold : {0.0, 0.3}) {
            Random random(1, 0, threshold > 0.0 ? 1 : 0);
            for (const double b : {0.0, 4.0, 9.0}) {
                const VoxelRay ray = medium.toVoxel(rayBeside(b));
                RunningMean mean;
                for (int i = 0; i < 100'000; ++i) mean.add(ratioTrack(medium, grid, ray, random, 1.0, threshold));
                EXPECT_NEAR(mean.mean(), integrateAlong(std::array{opticalPieces(medium, ray)}).transmittance,
                            4.0 * mean.standardError());
            }
        }
    }
}

/// A ball that only absorbs lets the sky through as e^{−σ·chord}.
TEST(PathTracer, AbsorbingBallIsAnalytic) {
    scene::Scene scene = ballScene(2.0, 0.0);
    scene.clouds[0].albedo = dvec3(0.0);
    scene.sky.radiance = dvec3(1.0);
    const vdb::Volume ball = ballVolume(66, ballRadius);
    const PathTracer tracer(scene, {ball}, Majorant::local);
    Random random(2, 0, 0);
    for (const double b : {0.0, 3.0, 6.0, 9.0}) {
        RunningMean passed;
        for (int i = 0; i < 200'000; ++i) {
            const PathSample sample = tracer.trace(rayBeside(b), random);
            EXPECT_EQ(sample.radiance, dvec3(0.0));
            passed.add(sample.passed.x);
        }
        const double analytic = std::exp(-2.0 * std::sqrt(1.0 - b * b / (ballRadius * ballRadius)));
        // on top of the noise the voxels' stairs: .3 % of the chord
        EXPECT_NEAR(passed.mean(), analytic, 4.0 * passed.standardError() + 0.003);
    }
}

/// Distance from `point` within the ball to its surface.
double chordTo(const dvec3& point, const dvec3& direction) {
    const double b = glm::dot(point, direction);
    return -b + std::sqrt(b * b - glm::dot(point, point) + ballRadius * ballRadius);
}

/// Light of one scattering, by numeric integration over the view ray through an ideal ball. The third channel's albedo
/// is so small that its light is that of one scattering to .1 %.
TEST(PathTracer, SingleScatteringAgreesWithQuadrature) {
    constexpr double tau = 1.0, faint = 1e-3;
    scene::Scene scene = ballScene(tau, 0.6);
    scene.clouds[0].albedo = dvec3(1.0, 0.5, faint);
    scene.sun.irradiance = dvec3(3.0);
    scene.sun.directionTo = glm::normalize(dvec3(1.0, 0.7, 0.4));
    const vdb::Volume ball = ballVolume(66, ballRadius);
    const PathTracer tracer(scene, {ball}, Majorant::local);
    const PhaseFunction phase(scene.clouds[0].phase);
    const double extinction = scene.clouds[0].extinction;
    Random random(3, 0, 0);
    for (const double b : {0.0, 5.0, -7.0}) {
        const double half = std::sqrt(ballRadius * ballRadius - b * b);
        const double p = phase.evaluate(oneMinusCosBetween({0.0, 0.0, -1.0}, scene.sun.directionTo));
        double integral = 0.0;
        constexpr int steps = 2000;
        for (int i = 0; i < steps; ++i) {
            const double depth = 2.0 * half * (i + 0.5) / steps;
            const dvec3 point(b, 0.0, half - depth);
            const double path = depth + chordTo(point, scene.sun.directionTo);
            integral += extinction * p * 3.0 * std::exp(-extinction * path) * 2.0 * half / steps;
        }
        RunningMean mean;
        for (int i = 0; i < 200'000; ++i) mean.add(tracer.trace(rayBeside(b), random).radiance.z / faint);
        EXPECT_LT(mean.standardError(), 0.01 * integral);
        EXPECT_NEAR(mean.mean(), integral, 4.0 * mean.standardError() + 0.005 * integral) << "at " << b;
    }
}

/// A wide sun gives the same light of one scattering as its disc, sampled by hand.
TEST(PathTracer, WideSunIsTheMeanOverItsDisc) {
    constexpr double faint = 1e-3;
    scene::Scene scene = ballScene(1.0, 0.8);
    scene.clouds[0].albedo = dvec3(1.0, 0.5, faint);
    scene.sun.irradiance = dvec3(1.0);
    scene.sun.directionTo = glm::normalize(dvec3(0.2, 0.1, -1.0));
    scene.sun.angularDiameter = 40.0;
    const vdb::Volume ball = ballVolume(34, ballRadius);
    const PathTracer wide(scene, {ball}, Majorant::local);
    Random random(4, 0, 0);
    RunningMean wideMean, discMean;
    for (int i = 0; i < 100'000; ++i) wideMean.add(wide.trace(rayBeside(2.0), random).radiance.z / faint);
    // irradiance E spread evenly over the disc: fluence E·2/(1 + cos 20°)
    const double cosRadius = std::cos(glm::radians(20.0));
    for (int i = 0; i < 200; ++i) {
        scene::Scene narrow = scene;
        narrow.sun.angularDiameter = 0.0;
        narrow.sun.irradiance = dvec3(2.0 / (1.0 + cosRadius));
        narrow.sun.directionTo = turned(scene.sun.directionTo, (1.0 - cosRadius) * (i + 0.5) / 200.0, random);
        const PathTracer tracer(narrow, {ball}, Majorant::local);
        double sum = 0.0;
        for (int k = 0; k < 500; ++k) sum += tracer.trace(rayBeside(2.0), random).radiance.z / faint;
        discMean.add(sum / 500.0);
    }
    EXPECT_NEAR(wideMean.mean(), discMean.mean(), 4.0 * std::hypot(wideMean.standardError(), discMean.standardError()));
    EXPECT_LT(wideMean.standardError(), 0.02 * wideMean.mean());
}

/// Without absorption every path ends in the sky, with its full weight.
TEST(PathTracer, WhiteFurnaceIsExact) {
    const vdb::Volume ball = ballVolume(24, ballRadius);
    for (const double tau : {2.0, 10.0, 50.0}) {
        scene::Scene scene = ballScene(tau, 0.85);
        scene.sky.radiance = dvec3(0.3, 1.0, 7.0);
        const PathTracer tracer(scene, {ball}, Majorant::local);
        Random random(5, 0, 0);
        int scattered = 0;
        for (int i = 0; i < 3000; ++i) {
            const PathSample sample = tracer.trace(rayBeside(0.003 * i), random);
            scattered += sample.passed.x > 0.0 ? 0 : 1;
            EXPECT_EQ(sample.passed * scene.sky.radiance + sample.radiance, scene.sky.radiance);
            EXPECT_FALSE(sample.lost);
        }
        EXPECT_GT(scattered, 1000);
    }
}

/// Albedo below one, the same in all channels: the weight does not change, the paths do.
TEST(PathTracer, RouletteIsUnbiased) {
    const vdb::Volume ball = ballVolume(24, ballRadius);
    scene::Scene scene = ballScene(6.0, 0.5);
    scene.sky.radiance = dvec3(1.0);
    scene.clouds[0].albedo = dvec3(0.8);
    const PathTracer alike(scene, {ball}, Majorant::local);
    scene.clouds[0].albedo = dvec3(1.0, 0.8, 0.3);  // no roulette: the weights carry the albedo
    const PathTracer colours(scene, {ball}, Majorant::local);
    Random random(6, 0, 0);
    RunningMean roulette, weights;
    for (int i = 0; i < 200'000; ++i) {
        roulette.add(alike.trace(rayBeside(1.0), random).radiance.x);
        weights.add(colours.trace(rayBeside(1.0), random).radiance.y);
    }
    EXPECT_NEAR(roulette.mean(), weights.mean(), 4.0 * std::hypot(roulette.standardError(), weights.standardError()));
}

/// In a dark cloud every path that collides sees the sun, although one in ten goes on: samples are alike, where a
/// roulette before the light would make nine of ten black (a mean square above 10 times the squared mean).
TEST(PathTracer, DarkCloudsAreNotNoisy) {
    const vdb::Volume ball = ballVolume(24, ballRadius);
    scene::Scene scene = ballScene(20.0, 0.0);
    scene.sun.irradiance = dvec3(1.0);
    scene.sun.directionTo = glm::normalize(dvec3(0.3, 0.2, 1.0));
    scene.clouds[0].albedo = dvec3(0.1);
    const PathTracer dark(scene, {ball}, Majorant::local);
    scene.clouds[0].albedo = dvec3(1.0, 0.1, 0.1);  // weights instead of a roulette
    const PathTracer colours(scene, {ball}, Majorant::local);
    Random random(9, 0, 0);
    RunningMean roulette, weights, squares;
    for (int i = 0; i < 50'000; ++i) {
        const double sample = dark.trace(rayBeside(1.0), random).radiance.x;
        roulette.add(sample);
        squares.add(sample * sample);
        weights.add(colours.trace(rayBeside(1.0), random).radiance.y);
    }
    EXPECT_NEAR(roulette.mean(), weights.mean(), 4.0 * std::hypot(roulette.standardError(), weights.standardError()));
    EXPECT_LT(squares.mean(), 4.0 * roulette.mean() * roulette.mean());
}

/// The faster majorants change nothing but the time.
TEST(PathTracer, LocalMajorantsAgreeWithTheGlobalOne) {
    vdb::Volume ball = ballVolume(40, ballRadius);
    for (std::size_t i = 0; i < ball.density.size(); ++i) ball.density[i] *= 0.05F + static_cast<float>(i % 7 == 0);
    scene::Scene scene = ballScene(8.0, 0.7);
    scene.sun.irradiance = dvec3(2.0);
    scene.sky.radiance = dvec3(0.4);
    const PathTracer global(scene, {ball}, Majorant::global), local(scene, {ball}, Majorant::local);
    Random random(7, 0, 0);
    for (const double b : {-6.0, 0.0, 8.0}) {
        RunningMean a, c;
        for (int i = 0; i < 60'000; ++i) {
            const PathSample one = global.trace(rayBeside(b), random), other = local.trace(rayBeside(b), random);
            a.add(0.4 * one.passed.x + one.radiance.x);
            c.add(0.4 * other.passed.x + other.radiance.x);
        }
        EXPECT_NEAR(a.mean(), c.mean(), 4.0 * std::hypot(a.standardError(), c.standardError())) << "at " << b;
    }
}

/// Irradiance of the disc's radiance on a plane that faces it: L·π·sin² of the angular radius.
TEST(PathTracer, SunDiscCarriesTheIrradiance) {
    scene::Scene scene;
    scene.clouds.clear();
    scene.sun.angularDiameter = 2.0;
    const PathTracer tracer(scene, {}, Majorant::global);
    const double sine = std::sin(glm::radians(1.0));
    const dvec3 seen = tracer.environment().discRadiance(scene.sun.directionTo) * glm::pi<double>() * sine * sine;
    EXPECT_NEAR(glm::distance(seen, scene.sun.irradiance), 0.0, 1e-12);
    Random random(8, 0, 0);
    const auto tilted = [&](double degrees) {
        return turned(scene.sun.directionTo, 1.0 - std::cos(glm::radians(degrees)), random);
    };
    EXPECT_GT(tracer.environment().discRadiance(tilted(0.99)).x, 0.0);
    EXPECT_EQ(tracer.environment().discRadiance(tilted(1.01)).x, 0.0);
    EXPECT_EQ(tracer.trace({}, random).passed, dvec3(1.0));
}

}  // namespace
}  // namespace lumulus::reference
