// One walk of photons through several clouds: overlaps add up, what is apart exchanges light, and all begins evenly.
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

constexpr int generations = 12, bands = 2;
constexpr double radius = 20.0;
const double y00 = std::sqrt(0.25 / std::numbers::pi);

/// An instance of a ball and what it is made of.
struct Ball {
    dvec3 at{0.0};
    test::MediumOptions medium;
    double share = 1.0;
    glm::dmat3 turned{1.0};  ///< and scaled
};

class ManyClouds : public test::VulkanTest {
  protected:
    cloud::Asset asset = cloud::prepare(context, ballVolume(26, radius), options());

    static cloud::PrepareOptions options() {
        cloud::PrepareOptions options = test::prepareOptions(1000, scene::Majorant::local);
        options.preparation.maxLeaves = 120;
        options.keepBlocks = true;
        return options;
    }
    /// A map of these balls after all generations.
    PhotonMap traced(const std::vector<Ball>& balls, const scene::Sun& sun, const scene::Sky& sky,
                     std::uint64_t photons, std::uint64_t seed = 1) {
        std::vector<cloud::Instance> instances(balls.size());
        std::vector<const cloud::Instance*> pointers;
        std::vector<MapPart> parts;
        std::vector<Placement> places;
        for (std::size_t i = 0; i < balls.size(); ++i) {
            instances[i].asset = &asset;
            pointers.push_back(&instances[i]);
            MapPart part;
            part.asset = &asset;
            part.medium = test::mediumOf(balls[i].medium);
            part.voxelToMetres = balls[i].turned * asset.voxelToMetres;
            part.share = balls[i].share;
            const dvec3 origin = balls[i].at - part.voxelToMetres * (0.5 * dvec3(asset.size));
            places.push_back({origin, part.medium.extinction, dvec3(1.0)});
            parts.push_back(std::move(part));
        }
        volumes_.push_back(std::make_unique<cloud::SharedVolumes>(cloud::makeSharedVolumes(context, pointers)));
        PhotonMap map(context, std::move(parts), *volumes_.back(), test::mapOptions(photons, generations, bands, seed));
        map.place(places);
        for (int i = 0; i < generations; ++i) map.trace(sun, sky);
        const Counters counters = map.counters();
        EXPECT_EQ(counters.emitted, counters.absorbed + counters.escaped);
        EXPECT_EQ(counters.lost + counters.saturated, 0U);
        return map;
    }
    /// Of a coefficient of each collector, radiance per mass: mean and error over the generations.
    static std::vector<RunningMean> levels(const PhotonMap& map, int k = 0) {
        const std::vector<double> masses = map.masses();
        std::vector<RunningMean> means(masses.size());
        for (int g = 0; g < generations; ++g) {
            const std::vector<std::int64_t> slot = map.downloadSlot(g);
            for (std::size_t i = 0; i < masses.size(); ++i)
                means[i].add(test::coefficient(slot, i, 0, k, bands) * map.unit() * y00 / masses[i]);
        }
        return means;
    }
    static void expectNormal(const RunningMean& squares, double worst, const char* what) {
        EXPECT_LT(worst, 5.0) << what;
        EXPECT_NEAR(squares.mean(), 1.0, 0.3) << what;
    }

  private:
    std::vector<std::unique_ptr<cloud::SharedVolumes>> volumes_;
};

/// Clouds that do not absorb, of other phase functions and optical thickness, one of them scaled and rotated,
/// overlapping and apart, are all filled with the light of the sky, however unevenly photons begin.
TEST_F(ManyClouds, AreFilledInAFurnace) {
    const double angle = 0.7;
    const glm::dmat3 turned = 0.8 * glm::dmat3(dvec3(std::cos(angle), std::sin(angle), 0.0),
                                               dvec3(-std::sin(angle), std::cos(angle), 0.0), dvec3(0.0, 0.0, 1.0));
    scene::Phase droplets;
    droplets.model = scene::PhaseModel::droplet;
    droplets.dropletDiameter = 12.0;
    const std::vector<Ball> balls{
        {dvec3(0.0), {.extinction = 0.1, .bands = bands, .cut = 12.0}, 0.6},
        {dvec3(15.0, 10.0, 3.0), {.extinction = 0.25, .phase = droplets, .bands = bands}, 0.3, turned},
        {dvec3(-70.0, 35.0, 40.0), {.extinction = 0.05, .bands = bands}, 0.1}};
    const PhotonMap map = traced(balls, test::noSun(), test::skyOf(dvec3(2.0)), 90'000);
    EXPECT_EQ(map.counters().absorbed, 0U);
    RunningMean squares, slopes;
    double worst = 0.0, worstSlope = 0.0;
    const std::vector<double> masses = map.masses();
    for (const int k : {0, 1, 2, 3}) {
        const std::vector<RunningMean> found = levels(map, k);
        for (std::size_t i = 0; i < found.size(); ++i) {
            if (masses[i] < 1.0) continue;  // too few photons for a normal distribution
            const double t = (found[i].mean() - (k == 0 ? 2.0 : 0.0)) / found[i].standardError();
            const double z = test::studentDeviation(t, generations - 1);
            (k == 0 ? squares : slopes).add(z * z);
            (k == 0 ? worst : worstSlope) = std::max(k == 0 ? worst : worstSlope, std::abs(z));
        }
    }
    expectNormal(squares, worst, "level");
    expectNormal(slopes, worstSlope, "first band");
}

/// Half of the extinction twice at one place, and an eighth eight times, is the whole once: in sun and sky, for a
/// medium that absorbs, collector by collector.
TEST_F(ManyClouds, PartsAtOnePlaceAreTheWhole) {
    const scene::Sun sun = test::sunFrom({0.3, 1.0, 0.2}, dvec3(5.0));
    const scene::Sky sky = test::skyOf(dvec3(1.0));
    const test::MediumOptions medium{.extinction = 0.15, .albedo = dvec3(0.98), .bands = bands};
    PhotonMap whole(context, asset, test::mediumOf(medium), test::mapOptions(30'000, generations, bands, 7));
    for (int i = 0; i < generations; ++i) whole.trace(sun, sky);
    const std::vector<RunningMean> once = levels(whole);
    for (const int n : {2, 8}) {
        test::MediumOptions part = medium;
        part.extinction /= n;
        const std::vector<Ball> balls(static_cast<std::size_t>(n), Ball{dvec3(0.0), part, 1.0 / n});
        const std::vector<RunningMean> parts = levels(traced(balls, sun, sky, 60'000));
        ASSERT_EQ(parts.size(), once.size() * static_cast<std::size_t>(n));
        RunningMean squares;
        double worst = 0.0;
        for (std::size_t i = 0; i < parts.size(); ++i) {
            const RunningMean& expected = once[i % once.size()];
            const double error = std::hypot(parts[i].standardError(), expected.standardError());
            if (!(error > 0.0) || error > 0.2 * expected.mean()) continue;
            const double z = test::studentDeviation((parts[i].mean() - expected.mean()) / error, 2 * (generations - 1));
            squares.add(z * z);
            worst = std::max(worst, std::abs(z));
        }
        expectNormal(squares, worst, std::to_string(n).c_str());
    }
}

/// The same generations have the same bits, and clouds that all move together too.
TEST_F(ManyClouds, AreDeterministic) {
    const test::MediumOptions medium{.extinction = 0.1, .bands = bands};
    const scene::Sun sun = test::sunFrom({0.3, 1.0, 0.2}, dvec3(5.0));
    const std::vector<Ball> balls{{dvec3(0.0), medium, 0.5}, {dvec3(30.0, 8.0, 0.0), medium, 0.5}};
    PhotonMap a = traced(balls, sun, test::skyOf(dvec3(1.0)), 5'000),
              b = traced(balls, sun, test::skyOf(dvec3(1.0)), 5'000);
    EXPECT_EQ(a.downloadSum(), b.downloadSum());
    PhotonMap other = traced(balls, sun, test::skyOf(dvec3(1.0)), 5'000, 2);
    EXPECT_NE(a.downloadSum(), other.downloadSum());
}

}  // namespace
}  // namespace lumulus::photon
