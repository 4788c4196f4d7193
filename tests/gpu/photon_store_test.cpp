// What the store keeps of the photons: exact relations between its counters.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "light/photon/photon_map.h"
#include "support/cloud_cases.h"
#include "support/photon_setup.h"
#include "support/vulkan_fixture.h"

namespace lumulus::photon {
namespace {

using glm::dvec3;

class PhotonStore : public test::VulkanTest {
  protected:
    cloud::Asset cloud = cloud::prepare(context, ballVolume(18, 20.0), test::prepareOptions(400));

    Counters traced(const Medium& medium, const scene::Sun& sun, const scene::Sky& sky, std::uint64_t photons) {
        PhotonMap map(context, cloud, medium, test::mapOptions(photons, 1, 1));
        map.trace(sun, sky);
        return map.counters();
    }
};

/// In a black cloud every collision is a photon's first: those of the sky are stored, those of the sun are drawn
/// otherwise. So the records tell which light a photon came from.
TEST_F(PhotonStore, SunsFirstScatteringIsNotStored) {
    const Medium black = test::mediumOf({.extinction = 0.05, .albedo = dvec3(0.0)});
    const scene::Sun sun = test::sunFrom({1, 2, 0}, dvec3(2.0), 0.53);
    const Counters bySun = traced(black, sun, test::skyOf(dvec3(0.0)), 5000);
    EXPECT_GT(bySun.events, 0U);
    EXPECT_EQ(bySun.records, 0U) << "a black sky sends no photon";
    const Counters bySky = traced(black, test::noSun(), test::skyOf(dvec3(2.0)), 5000);
    EXPECT_GT(bySky.events, 0U);
    EXPECT_EQ(bySky.records, bySky.events) << "a dark sun sends no photon";
    const Counters both = traced(black, sun, test::skyOf(dvec3(0.5)), 5000);
    EXPECT_GT(both.records, 0U);
    EXPECT_LT(both.records, both.events);
}

/// No record is dropped, also where the store is full many times over: every collision of the sky's light is one.
TEST_F(PhotonStore, FullStoreDropsNothing) {
    const Medium medium = test::mediumOf({.extinction = 5.0, .phase = {.g = 0.0}});
    // 2 M records fit into a round, on average 70 collisions a photon
    const Counters counters = traced(medium, test::noSun(), test::skyOf(dvec3(1.0)), 40000);
    EXPECT_GT(counters.events, std::uint64_t{1} << 21U);
    EXPECT_EQ(counters.records, counters.events);
    EXPECT_EQ(counters.escaped, 40000U);
}

TEST_F(PhotonStore, EveryPhotonEnds) {
    struct Case {
        dvec3 albedo;
        bool cut;
        std::uint64_t photons;
    };
    const dvec3 mixed(0.3, 0.9, 0.0), redEats(0.5, 1.0, 1.0);
    const Medium whole = test::mediumOf({.extinction = 0.2}), cut = test::mediumOf({.extinction = 0.2, .cut = 12.0});
    for (const Case& c : {Case{dvec3(0.0), false, 5000}, Case{mixed, false, 5000}, Case{mixed, true, 5000},
                          Case{redEats, true, 5000}, Case{dvec3(1.0), false, 63}, Case{dvec3(1.0), true, 1}}) {
        const Medium medium = test::withAlbedo(c.cut ? cut : whole, c.albedo);
        const Counters counters =
            traced(medium, test::sunFrom({1, 1, 1}, dvec3(1.0), 0.53), test::skyOf({0.1, 0.2, 0.3}), c.photons);
        EXPECT_EQ(counters.emitted, c.photons);
        EXPECT_EQ(counters.absorbed + counters.escaped, c.photons);
        EXPECT_EQ(counters.lost, 0U);
        EXPECT_EQ(counters.saturated, 0U);
        // the roulette looks at the largest channel: none dies where one channel is not absorbed
        EXPECT_EQ(counters.absorbed > 0, c.albedo == dvec3(0.0) || c.albedo == mixed);
    }
}

TEST_F(PhotonStore, DarkLightsTraceNothing) {
    PhotonMap map(context, cloud, test::mediumOf({}), test::mapOptions(1000, 2, 1));
    map.trace(test::noSun(), test::skyOf(dvec3(0.0)));
    EXPECT_EQ(map.counters().emitted, 0U);
    EXPECT_THAT(map.downloadSum(), testing::Each(0));
    for (const gpu::Step& step : map.steps()) EXPECT_NE(step.name, "trace");
    map.trace(test::noSun(), test::skyOf(dvec3(1.0)));
    EXPECT_EQ(map.counters().emitted, 1000U);
    EXPECT_THAT(map.downloadSum(), testing::Contains(testing::Ne(0)));
}

/// The rounds' passes and the barriers between them, as a list: validation misses a lack between two writers.
TEST_F(PhotonStore, PassesOfAGeneration) {
    PhotonMap map(context, cloud, test::mediumOf({}), test::mapOptions(1000, 2, 1));
    map.trace(test::noSun(), test::skyOf(dvec3(1.0)));
    std::vector<std::string> names;
    for (const gpu::PassTime& pass : map.times()) names.push_back(pass.name);
    EXPECT_THAT(names, testing::ElementsAre("trace", "sort", "gather", "accumulate"));
}

/// Mirrored and sheared volumes are lit from the right sides: all of the sun's photons walk into the box. In a black,
/// thick cloud that fills the box only those that touch its rim escape.
TEST_F(PhotonStore, SunEntersMirroredVolumes) {
    for (const double mirror : {1.0, -1.0}) {
        vdb::Volume box = boxVolume({12, 12, 12});
        box.toWorld.linear = glm::dmat3(dvec3(mirror * 3.0, 0.5, 0), dvec3(0.4, 2.0, 0), dvec3(0, 0.3, 2.5));
        cloud = cloud::prepare(context, box, test::prepareOptions(300));
        const Medium black = test::mediumOf({.extinction = 30.0, .albedo = dvec3(0.0)});
        for (const dvec3 to : {dvec3(1, 2, 3), dvec3(-3, -1, 2), dvec3(0, 0, -1)}) {
            const Counters c = traced(black, test::sunFrom(to, dvec3(1.0)), test::skyOf(dvec3(0.0)), 2000);
            EXPECT_GT(c.absorbed, 1500U);
        }
    }
}

}  // namespace
}  // namespace lumulus::photon
