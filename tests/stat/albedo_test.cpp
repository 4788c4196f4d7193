// Absorption: Russian roulette over RGB weights loses nothing on the average.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "light/photon/photon_map.h"
#include "support/cloud_cases.h"
#include "support/deviation.h"
#include "support/photon_setup.h"
#include "support/statistics.h"
#include "support/vulkan_fixture.h"

namespace lumulus::photon {
namespace {

using glm::dvec3;
using test::RunningMean;

/// Power that meets turns in the whole cloud, by channel and generation: Σ c_00·√4π, 1 − albedo of which is absorbed.
struct Turned {
    RunningMean channel[3];
    Counters counters;
};

class Absorption : public test::VulkanTest {
  protected:
    static constexpr int generations = 12;
    static constexpr std::uint64_t photons = 8000;
    static constexpr double extinction = 0.15;
    cloud::Asset cloud = cloud::prepare(context, ballVolume(18, 20.0), test::prepareOptions(300));

    Turned turned(const Medium& medium, const scene::Sun& sun, const scene::Sky& sky, std::uint64_t seed) {
        PhotonMap map(context, cloud, medium, test::mapOptions(photons, generations, 1, seed));
        Turned result;
        for (int i = 0; i < generations; ++i) map.trace(sun, sky);
        for (int i = 0; i < generations; ++i) {
            const auto slot = map.downloadSlot(i);
            for (int channel = 0; channel < 3; ++channel) {
                double sum = 0.0;
                for (std::size_t c = 0; c < cloud.collectors.size(); ++c)
                    sum += test::coefficient(slot, c, channel, 0, 1);
                result.channel[channel].add(sum * map.unit() * std::sqrt(4.0 * std::numbers::pi));
            }
        }
        result.counters = map.counters();
        return result;
    }
};

/// Two means over the generations differ by less than 4 standard errors.
void expectEqualMeans(const RunningMean& a, const RunningMean& b, int generations) {
    const double error = std::hypot(a.standardError(), b.standardError());
    EXPECT_GT(a.mean(), 20.0 * error);  // the comparison says something
    const double z = test::studentDeviation((a.mean() - b.mean()) / error, 2.0 * (generations - 1));
    EXPECT_LT(std::abs(z), 4.0) << a.mean() << " and " << b.mean();
}

/// Each channel of a coloured cloud absorbs what a grey cloud of its albedo does; the grey one of albedo 1 has no
/// roulette, that of albedo 0 only first collisions.
TEST_F(Absorption, ColouredCloudIsThreeGreyOnes) {
    const dvec3 albedo(1.0, 0.6, 0.0);
    const scene::Sky sky = test::skyOf(dvec3(1.0));
    for (const double cut : {0.0, 12.0}) {
        SCOPED_TRACE(testing::Message() << "forward cut " << cut);
        const Medium medium = test::mediumOf({.extinction = extinction, .cut = cut});
        const Turned colour = turned(test::withAlbedo(medium, albedo), test::noSun(), sky, 1);
        for (int channel = 0; channel < 3; ++channel) {
            const Medium grey = test::withAlbedo(medium, dvec3(albedo[channel]));
            expectEqualMeans(colour.channel[channel], turned(grey, test::noSun(), sky, 2).channel[0], generations);
        }
    }
}

/// The same in coloured light of both kinds.
TEST_F(Absorption, ColouredSunlight) {
    const dvec3 albedo(0.3, 0.9, 0.95);
    const scene::Sun sun = test::sunFrom({1, 2, 3}, {2.0, 0.5, 1.0}, 0.53);
    const scene::Sky sky = test::skyOf({0.0, 0.2, 0.1});
    const Medium medium = test::mediumOf({.extinction = extinction});
    const Turned colour = turned(test::withAlbedo(medium, albedo), sun, sky, 1);
    for (int channel = 0; channel < 3; ++channel) {
        const Medium grey = test::withAlbedo(medium, dvec3(albedo[channel]));
        expectEqualMeans(colour.channel[channel], turned(grey, sun, sky, 2).channel[channel], generations);
    }
}

/// Of the collisions in a grey cloud 1 − albedo are the last: a binomial number of them.
TEST_F(Absorption, CollisionsAbsorbTheirShare) {
    for (const double albedo : {0.2, 0.9, 0.99}) {
        const Medium medium = test::mediumOf({.extinction = extinction, .albedo = dvec3(albedo)});
        const Counters c = turned(medium, test::noSun(), test::skyOf(dvec3(1.0)), 3).counters;
        const auto events = static_cast<double>(c.events);
        EXPECT_LT(std::abs(static_cast<double>(c.absorbed) - (1.0 - albedo) * events),
                  4.0 * std::sqrt(events * albedo * (1.0 - albedo)));
        EXPECT_EQ(c.records, c.events);
    }
}

/// Absorbed by the collectors' account is absorbed by the count of photons: they carry one power in a grey cloud.
TEST_F(Absorption, EnergyIsConserved) {
    const Medium medium = test::mediumOf({.extinction = extinction, .albedo = dvec3(0.8)});
    const Turned t = turned(medium, test::noSun(), test::skyOf(dvec3(1.0)), 4);
    const double edge = cloud.voxelToMetres[0][0] * cloud.size.x;
    const double power = std::numbers::pi * 6.0 * edge * edge / static_cast<double>(photons);
    const double collided = t.channel[1].mean() * generations;
    EXPECT_NEAR(collided, power * static_cast<double>(t.counters.events), 1e-4 * collided);
    EXPECT_EQ(t.counters.absorbed + t.counters.escaped, t.counters.emitted);
}

}  // namespace
}  // namespace lumulus::photon
