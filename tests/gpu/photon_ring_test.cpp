// The ring of generations: exact sums, and the same bits for the same seed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "base/error.h"
#include "gpu/transfer.h"
#include "light/photon/photon_map.h"
#include "support/cloud_cases.h"
#include "support/photon_setup.h"
#include "support/vulkan_fixture.h"

namespace lumulus::photon {
namespace {

using glm::dvec3;

class PhotonRing : public test::VulkanTest {
  protected:
    static constexpr int bands = 3;
    static constexpr int slots = 4;
    cloud::Asset cloud = cloud::prepare(context, ballVolume(18, 20.0), test::prepareOptions(400));
    Medium medium = test::mediumOf({.extinction = 0.1, .albedo = {1.0, 0.9, 0.7}, .bands = bands});

    Options options(std::uint64_t seed = 1) const { return test::mapOptions(3000, slots, bands, seed); }

    /// Lights that repeat with the ring; powers range over a factor of 1e6, and one generation is dark.
    static scene::Sun sunAt(int generation) {
        const double power[slots] = {2.0, 300.0, 0.0, 3e-4};
        return test::sunFrom({0.3 * generation, 1.0, 0.2}, power[generation % slots] * dvec3(1.0, 0.8, 0.1), 0.53);
    }
    static scene::Sky skyAt(int generation) {
        const double radiance[slots] = {0.1, 0.0, 0.0, 0.7e-4};
        return test::skyOf(radiance[generation % slots] * dvec3(0.2, 0.5, 1.0));
    }
    static void run(PhotonMap& map, int first, int last) {
        for (int generation = first; generation < last; ++generation)
            map.trace(sunAt(generation % slots), skyAt(generation % slots));
    }
    std::vector<double> watts(const Light& light) {
        std::vector<double> values;
        for (const std::int64_t count : gpu::download<std::int64_t>(context, *light.counts))
            values.push_back(light.unit * static_cast<double>(count));
        return values;
    }
    static std::vector<std::int64_t> sumOfSlots(const PhotonMap& map) {
        std::vector<std::int64_t> sum = map.downloadSlot(0);
        for (int slot = 1; slot < slots; ++slot) {
            const std::vector<std::int64_t> values = map.downloadSlot(slot);
            for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += values[i];
        }
        return sum;
    }
};

TEST_F(PhotonRing, RunningSumIsTheSumOfTheSlots) {
    PhotonMap map(context, cloud, medium, options());
    for (int round = 0; round < 3; ++round) {
        run(map, round * slots, (round + 1) * slots);
        ASSERT_EQ(map.downloadSum(), sumOfSlots(map)) << "after " << (round + 1) * slots << " generations";
    }
    EXPECT_EQ(map.generationsInRing(), slots);
    EXPECT_EQ(map.counters().saturated, 0U);
    EXPECT_THAT(map.downloadSum(), testing::Contains(testing::Ne(0)));
    EXPECT_THAT(map.downloadSlot(2), testing::Each(0)) << "the dark generation";
}

/// Nothing is left of the generations that went: a map that begins with the last p holds the same.
TEST_F(PhotonRing, ReplacedGenerationsLeaveNoResidue) {
    PhotonMap map(context, cloud, medium, options());
    run(map, 0, 3 * slots);
    Options late = options();
    late.firstGeneration = 2 * slots;
    PhotonMap fresh(context, cloud, medium, late);
    run(fresh, 2 * slots, 3 * slots);
    EXPECT_EQ(fresh.unit(), map.unit());
    EXPECT_EQ(fresh.downloadSum(), map.downloadSum());
}

/// A picture that stops at p generations keeps no slots; its sum is the same.
TEST_F(PhotonRing, SumWithoutSlotsIsTheSame) {
    PhotonMap map(context, cloud, medium, options());
    Options withoutSlots = options();
    withoutSlots.keepRing = false;
    PhotonMap lean(context, cloud, medium, withoutSlots);
    run(map, 0, slots);
    run(lean, 0, slots);
    EXPECT_EQ(lean.downloadSum(), map.downloadSum());
}

/// Where no generation goes, and all have one unit, they add up where they are traced: no sum, no pass for it. Also
/// generations of so many photons that records as fine as they can be would be finer than the ring.
TEST_F(PhotonRing, LightOfOneBufferIsThatOfTheRing) {
    for (const std::uint64_t photons : {std::uint64_t{3000}, std::uint64_t{1} << 21U}) {
        Options ring = options();
        ring.photonsPerGeneration = photons;
        Options one = ring;
        one.keepRing = false;
        PhotonMap map(context, cloud, medium, ring), lean(context, cloud, medium, one);
        for (PhotonMap* each : {&map, &lean})
            for (int generation = 0; generation < 2; ++generation) each->trace(sunAt(0), skyAt(0));
        lean.settle();
        for (const gpu::PassTime& pass : lean.times()) EXPECT_NE(pass.name, "accumulate") << photons << " photons";
        EXPECT_EQ(watts(lean.light()), watts(map.light())) << photons << " photons";
        EXPECT_EQ(lean.downloadSum(), map.downloadSum()) << photons << " photons";
    }
}

/// Light of before stays when a generation is cut off between two rounds, and the next one has the bits that it has
/// without that: in a ring, in one buffer, and where even and odd generations are apart.
TEST_F(PhotonRing, ACutOffGenerationLeavesNothing) {
    medium = test::mediumOf({.extinction = 20.0, .phase = {.g = 0.0}, .bands = bands});  // many rounds
    for (int kind = 0; kind < 3; ++kind) {
        Options wanted = test::mapOptions(2000, slots, bands);
        wanted.keepRing = kind == 0;
        wanted.splitGenerations = kind == 2;
        PhotonMap map(context, cloud, medium, wanted), other(context, cloud, medium, wanted);
        for (int generation = 0; generation < 3; ++generation) {
            EXPECT_FALSE(map.tryTrace(sunAt(0), skyAt(0), {[] { return true; }})) << kind;
            int asked = 0;
            EXPECT_FALSE(map.tryTrace(sunAt(0), skyAt(0), {[&] { return ++asked == 3; }})) << kind;
            EXPECT_EQ(asked, 3);
            EXPECT_EQ(map.generationsInRing(), generation);
            EXPECT_TRUE(map.tryTrace(sunAt(0), skyAt(0), {[] { return false; }}));
            map.keep();
            other.trace(sunAt(0), skyAt(0));
        }
        EXPECT_EQ(map.counters().events, other.counters().events) << kind;
        EXPECT_EQ(map.counters().emitted, 6000U);
        EXPECT_EQ(map.downloadSum(), other.downloadSum()) << kind;
        EXPECT_THAT(map.downloadSum(), testing::Contains(testing::Ne(0)));
    }
}

/// However short rounds are, a generation has the same bits. Between two of them a ring has the light of before.
TEST_F(PhotonRing, ShortRoundsHaveTheSameBitsAndShowTheLightOfBefore) {
    medium = test::mediumOf({.extinction = 20.0, .phase = {.g = 0.0}, .bands = bands});
    PhotonMap* seen = nullptr;
    std::vector<std::vector<double>> between;
    Options wanted = test::mapOptions(2000, slots, bands);
    wanted.check = [&] {
        if (seen != nullptr && between.size() < 5) between.push_back(watts(seen->light()));
    };
    PhotonMap map(context, cloud, medium, wanted), other(context, cloud, medium, test::mapOptions(2000, slots, bands));
    for (int generation = 0; generation < 3; ++generation) {
        const std::vector<double> before = watts(map.light());
        const double powerBefore = map.photonPower();
        between.clear();
        seen = &map;
        int asked = 0;
        const auto shortTime = [&] { return ++asked < 6 ? 1e-9 : 1e-2; };
        EXPECT_TRUE(map.tryTrace(sunAt(generation), skyAt(0), {{}, false, shortTime}));
        seen = nullptr;
        EXPECT_GT(asked, 5);
        EXPECT_EQ(map.photonPower(), powerBefore);
        EXPECT_THAT(between, testing::SizeIs(testing::Ge(5)));
        EXPECT_THAT(between, testing::Each(before));
        map.keep();
        other.trace(sunAt(generation), skyAt(0));
        EXPECT_EQ(map.downloadSum(), other.downloadSum());
        EXPECT_EQ(map.counters().events, other.counters().events);
    }
}

/// What ends a walk by an exception does not hurt the light of a ring either, as when a client has gone.
TEST_F(PhotonRing, AnExceptionBetweenRoundsLeavesTheLightOfBefore) {
    medium = test::mediumOf({.extinction = 20.0, .phase = {.g = 0.0}, .bands = bands});
    int rounds = 0;
    bool ends = false;
    Options wanted = test::mapOptions(2000, slots, bands);
    wanted.check = [&] {
        if (ends && ++rounds == 2) throw std::runtime_error("the client has gone");
    };
    PhotonMap map(context, cloud, medium, wanted), other(context, cloud, medium, wanted);
    map.trace(sunAt(0), skyAt(0));
    ends = true;
    EXPECT_THROW(map.trace(sunAt(0), skyAt(0)), std::runtime_error);
    ends = false;
    map.trace(sunAt(0), skyAt(0));
    for (int generation = 0; generation < 2; ++generation) other.trace(sunAt(0), skyAt(0));
    EXPECT_EQ(map.downloadSum(), other.downloadSum());
}

/// Photons on their way are given up where that is asked for, and counted.
TEST_F(PhotonRing, UnfinishedPhotonsAreCountedAsLost) {
    medium = test::mediumOf({.extinction = 20.0, .phase = {.g = 0.0}, .bands = bands});
    PhotonMap map(context, cloud, medium, test::mapOptions(2000, slots, bands));
    EXPECT_EQ(map.shrinkGenerations(64, 64), 64U);
    EXPECT_TRUE(map.tryTrace(test::noSun(), skyAt(0), {[] { return true; }, true}));
    map.keep();
    const Counters counters = map.counters();
    EXPECT_EQ(counters.emitted, 64U);
    EXPECT_GT(counters.lost, 0U);
    EXPECT_EQ(counters.absorbed + counters.escaped + counters.lost, 64U);
    EXPECT_THAT(map.downloadSum(), testing::Contains(testing::Ne(0)));
}

TEST_F(PhotonRing, SameSeedSameBits) {
    std::vector<std::vector<std::int64_t>> sums;
    for (const std::uint64_t seed : {std::uint64_t{1}, std::uint64_t{1}, std::uint64_t{2}, std::uint64_t{1} << 40U}) {
        PhotonMap map(context, cloud, medium, options(seed));
        run(map, 0, slots);
        sums.push_back(map.downloadSum());
    }
    EXPECT_EQ(sums[0], sums[1]);
    EXPECT_NE(sums[0], sums[2]);
    EXPECT_NE(sums[0], sums[3]) << "the high half of the seed counts";
}

TEST_F(PhotonRing, GenerationsDiffer) {
    PhotonMap map(context, cloud, medium, options());
    map.trace(sunAt(0), skyAt(0));
    map.trace(sunAt(0), skyAt(0));
    EXPECT_NE(map.downloadSlot(0), map.downloadSlot(1));
    EXPECT_EQ(map.generationsInRing(), 2);
}

/// Refused before any memory is taken, with what is needed and what there is.
TEST_F(PhotonRing, MoreThanTheBudgetIsRefused) {
    const auto refusal = [&](const Options& wanted) -> std::string {
        const std::uint64_t before = context.memory().used;
        try {
            PhotonMap(context, cloud, medium, wanted);
        } catch (const InputError& e) {
            EXPECT_EQ(context.memory().used, before);
            return e.what();
        }
        return "";
    };
    Options wanted = options();
    wanted.generations = 4096;
    // a generation of this cloud: collectors · RGB · bands² · 8 bytes
    const std::uint64_t each = cloud.collectors.size() * 3 * bands * bands * 8;
    wanted.memoryBudget = 4098 * each - 1;
    EXPECT_THAT(refusal(wanted), testing::HasSubstr("4098 times"));
    wanted.keepRing = false;
    EXPECT_EQ(refusal(wanted), "");
    wanted.memoryBudget = 2 * each - 1;
    EXPECT_THAT(refusal(wanted), testing::HasSubstr("(photon_map.memory_budget)"));
    wanted.memoryBudget = 2 * each;
    EXPECT_EQ(refusal(wanted), "");
}

}  // namespace
}  // namespace lumulus::photon
