// Free paths follow exp(−σ s): in a black cloud a photon of the sun gets through with the transmittance of its ray.
#include <gtest/gtest.h>

#include <cmath>

#include "light/photon/photon_map.h"
#include "support/cloud_cases.h"
#include "support/field.h"
#include "support/photon_setup.h"
#include "support/sun_transmittance.h"
#include "support/vulkan_fixture.h"

namespace lumulus::photon {
namespace {

using glm::dvec3;

class FreePath : public test::VulkanTest {
  protected:
    static constexpr std::uint64_t photons = 200'000;

    /// Escaped photons against the expected share of them, in standard errors of the binomial distribution.
    void expectEscaping(const cloud::Asset& cloud, double extinction, const scene::Sun& sun, double transmittance) {
        const Medium black = test::mediumOf({.extinction = extinction, .albedo = dvec3(0.0)});
        PhotonMap map(context, cloud, black, test::mapOptions(photons, 1, 1));
        map.trace(sun, test::skyOf(dvec3(0.0)));
        const Counters& counters = map.counters();
        ASSERT_EQ(counters.escaped + counters.absorbed, photons);
        EXPECT_EQ(counters.events, counters.absorbed);
        const auto n = static_cast<double>(photons);
        const double error = std::sqrt(n * transmittance * (1.0 - transmittance));
        EXPECT_LT(std::abs(static_cast<double>(counters.escaped) - n * transmittance), 4.0 * error)
            << "extinction " << extinction << ", transmittance " << transmittance;
    }
};

/// The density between voxels fades over the outermost half voxels: in a box of n voxels of density 1 it is
/// f(x)·f(y)·f(z) with f a trapezium of area n.
double boxTransmittance(int n, double depth) {
    constexpr int parts = 24;
    const auto profile = [n](double x) { return std::clamp(std::min(x - 0.5, n + 1.5 - x), 0.0, 1.0); };
    double sum = 0.0;
    const int points = (n + 2) * parts;
    for (int i = 0; i < points; ++i)
        for (int j = 0; j < points; ++j)
            sum += std::exp(-depth * profile((i + 0.5) / parts) * profile((j + 0.5) / parts));
    return sum / (static_cast<double>(points) * points);
}

TEST_F(FreePath, AlongTheAxisOfABox) {
    constexpr int n = 30;
    for (const scene::Majorant majorant : {scene::Majorant::local, scene::Majorant::global}) {
        const cloud::Asset cloud = cloud::prepare(context, boxVolume({n, n, n}), test::prepareOptions(200, majorant));
        for (const double depth : {0.1, 1.0, 5.0})
            expectEscaping(cloud, depth / n, test::sunFrom({0, 0, 1}, dvec3(1.0)), boxTransmittance(n, depth));
    }
}

TEST_F(FreePath, ThroughABallFromTheSide) {
    constexpr double radius = 20.0;
    const vdb::Volume ball = ballVolume(26, radius);
    const test::Field field(ball);
    const dvec3 to(1.0, 2.0, -0.5);
    const test::SunRays rays = test::sunRays(field, ball.toWorld.linear, -to, 64);
    for (const scene::Majorant majorant : {scene::Majorant::local, scene::Majorant::global}) {
        const cloud::Asset cloud = cloud::prepare(context, ball, test::prepareOptions(200, majorant));
        for (const double depth : {0.1, 1.0, 5.0}) {
            const double extinction = depth / (2.0 * radius);
            expectEscaping(cloud, extinction, test::sunFrom(to, dvec3(1.0)), rays.meanTransmittance(extinction));
        }
    }
}

/// Voxels of unequal edges: metres count, not voxels.
TEST_F(FreePath, ThroughAShearedCloud) {
    const test::CloudCase c = test::cloudCases()[2];
    const test::Field field(c.volume);
    const dvec3 to(-1.0, 0.7, 0.4);
    const test::SunRays rays = test::sunRays(field, c.volume.toWorld.linear, -to, 64);
    const cloud::Asset cloud = cloud::prepare(context, c.volume, test::prepareOptions(200, scene::Majorant::local));
    for (const double extinction : {0.02, 0.2})
        expectEscaping(cloud, extinction, test::sunFrom(to, dvec3(1.0)), rays.meanTransmittance(extinction));
}

/// A hundred optical depths from face to face: what gets through is what passes beside.
TEST_F(FreePath, ThroughAThickBox) {
    constexpr int n = 30;
    const cloud::Asset cloud =
        cloud::prepare(context, boxVolume({n, n, n}), test::prepareOptions(200, scene::Majorant::local));
    expectEscaping(cloud, 100.0 / n, test::sunFrom({0, 0, 1}, dvec3(1.0)), boxTransmittance(n, 100.0));
}

}  // namespace
}  // namespace lumulus::photon
