// The white furnace: a cloud that absorbs nothing, in light that is the same from everywhere, is filled with the same
// light, whatever its density and shape.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "light/photon/emission.h"
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

constexpr int generations = 16;
constexpr int bands = 2;
const dvec3 sky(3.0, 1.0, 0.25);

struct FurnaceCase {
    std::string name;
    vdb::Volume volume;
    double extinction;
    std::uint64_t photons;  ///< a generation
    test::MediumOptions medium;
    scene::Majorant majorant;
    int leaves;
};

/// Deviations of all well-fed collectors from what is expected of them, in standard errors (of Student's distribution,
/// turned into normal deviates).
struct Deviations {
    RunningMean squares;
    double worst = 0.0;
    int count = 0;

    void add(const RunningMean& generationsOf, double expected) {
        const double t = (generationsOf.mean() - expected) / generationsOf.standardError();
        const double z = test::studentDeviation(t, generations - 1);
        squares.add(z * z);
        worst = std::max(worst, std::abs(z));
        ++count;
    }
    /// z² has mean 1 and, over independent collectors, a standard error of √(2/n). A photon feeds many collectors, so
    /// these are not independent: the bound is 4 of those errors, and not below 0.2.
    void expectNormal(const char* what) const {
        EXPECT_LT(worst, 5.0) << what;
        EXPECT_NEAR(squares.mean(), 1.0, std::max(0.2, 4.0 * std::sqrt(2.0 / count))) << what;
    }
};

/// Area of the box's six faces [m²].
double boxSurface(const cloud::Asset& cloud) {
    const glm::dmat3 faces = faceAreas(cloud.voxelToMetres, glm::dvec3(cloud.size));
    return 2.0 * (glm::length(faces[0]) + glm::length(faces[1]) + glm::length(faces[2]));
}

class Furnace : public test::VulkanTest {
  protected:
    void run(FurnaceCase c);
    static void expectFilled(const PhotonMap& map, double leastMass);
};

void Furnace::run(FurnaceCase c) {
    SCOPED_TRACE(c.name);
    cloud::PrepareOptions prepareOptions = test::prepareOptions(2000, c.majorant);
    prepareOptions.preparation.maxLeaves = c.leaves;
    const cloud::Asset cloud = cloud::prepare(context, c.volume, prepareOptions);
    c.medium.extinction = c.extinction;
    c.medium.bands = bands;
    PhotonMap map(context, cloud, test::mediumOf(c.medium), test::mapOptions(c.photons, generations, bands));
    for (int i = 0; i < generations; ++i) map.trace(test::noSun(), test::skyOf(sky));

    const Counters& counters = map.counters();
    EXPECT_EQ(counters.emitted, c.photons * generations);
    EXPECT_EQ(counters.emitted, counters.absorbed + counters.escaped);
    EXPECT_EQ(counters.absorbed, 0U);
    EXPECT_EQ(counters.lost, 0U);
    EXPECT_EQ(counters.saturated, 0U);
    // Sky photons all have one power; a collector is well fed by 20 of them a generation.
    const double power = sky.x * std::numbers::pi * boxSurface(cloud) / static_cast<double>(c.photons);
    expectFilled(map, 20.0 * power / (4.0 * std::numbers::pi * sky.x));
}

/// Checks the radiance of each collector of at least `leastMass` [m²], and of the whole cloud.
void Furnace::expectFilled(const PhotonMap& map, double leastMass) {
    std::vector<std::vector<std::int64_t>> slots;
    for (int i = 0; i < generations; ++i) slots.push_back(map.downloadSlot(i));
    const std::vector<double> masses = map.masses();
    const double allMass = std::accumulate(masses.begin(), masses.end(), 0.0);
    const double y00 = std::sqrt(0.25 / std::numbers::pi);
    Deviations level, slope, whole;
    std::vector<double> power(generations, 0.0);
    for (std::size_t i = 0; i < masses.size(); ++i) {
        for (int g = 0; g < generations; ++g)
            power[static_cast<std::size_t>(g)] +=
                test::coefficient(slots[static_cast<std::size_t>(g)], i, 0, 0, bands) * map.unit();
        if (masses[i] < leastMass) continue;
        for (int k = 0; k < bands * bands; ++k) {
            // c_00 = 4π L M y_00, and y_00² = 1/4π; the other coefficients of equal light are zero
            RunningMean mean;
            for (const auto& slot : slots)
                mean.add(test::coefficient(slot, i, 0, k, bands) * map.unit() * y00 / masses[i]);
            (k == 0 ? level : slope).add(mean, k == 0 ? sky.x : 0.0);
        }
        // a grey cloud: channels differ by the rounding of records only
        const double red = test::coefficient(slots[0], i, 0, 0, bands);
        EXPECT_NEAR(test::coefficient(slots[0], i, 1, 0, bands) * sky.x, red * sky.y, 1e-4 * red);
    }
    EXPECT_GT(level.count, 40);
    level.expectNormal("level");
    slope.expectNormal("first band");
    RunningMean mean;
    for (const double p : power) mean.add(p * y00 / allMass);
    whole.add(mean, sky.x);
    EXPECT_LT(whole.worst, 4.0) << "the whole cloud has " << mean.mean();
    EXPECT_LT(mean.standardError(), 0.02 * sky.x);
}

constexpr double radius = 20.0;

TEST_F(Furnace, ThinBall) {
    run({"thin", ballVolume(26, radius), 0.1 / (2 * radius), 250'000, {}, scene::Majorant::local, 200});
}

TEST_F(Furnace, BallOfOpticalThicknessTwo) {
    run({"two", ballVolume(26, radius), 2.0 / (2 * radius), 60'000, {}, scene::Majorant::global, 500});
}

TEST_F(Furnace, ThickBall) {
    run({"thick", ballVolume(26, radius), 50.0 / (2 * radius), 12'000, {}, scene::Majorant::automatic, 500});
}

TEST_F(Furnace, ForwardCut) {
    run({"cut", ballVolume(26, radius), 10.0 / (2 * radius), 30'000, {.cut = 12.0}, scene::Majorant::local, 500});
}

/// Voxels of unequal, oblique edges; a phase function that is sampled from its table.
TEST_F(Furnace, ShearedLumpsOfDroplets) {
    const glm::dmat3 edges(dvec3(3.0, 0.5, 0), dvec3(1.0, 2.0, 0.3), dvec3(0, -0.4, 2.5));
    const scene::Phase droplets{.model = scene::PhaseModel::droplet, .dropletDiameter = 12.0};
    run({"lumps",
         test::lumpyVolume({22, 25, 19}, edges, 2),
         0.2,
         50'000,
         {.phase = droplets},
         scene::Majorant::local,
         400});
}

}  // namespace
}  // namespace lumulus::photon
