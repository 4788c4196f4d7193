// The white furnace: a cloud that absorbs nothing, in light that is the same from everywhere, is filled with the same
// light, whatever its density and shape.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "photon/photon_map.h"
#include "support/cloud_cases.h"
#include "support/photon_setup.h"
#include "support/statistics.h"
#include "support/student.h"
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
    /// these are not independent: the bound is 6 of those errors, and not below 0.2.
    void expectNormal(const char* what) const {
        EXPECT_LT(worst, 5.0) << what;
        EXPECT_NEAR(squares.mean(), 1.0, std::max(0.2, 6.0 * std::sqrt(2.0 / count))) << what;
    }
};

class Furnace : public test::VulkanTest {
  protected:
    void run(FurnaceCase c);
};

void Furnace::run(FurnaceCase c) {
    SCOPED_TRACE(c.name);
    cloud::PrepareOptions prepareOptions = test::prepareOptions(2000, c.majorant);
    prepareOptions.preparation.maxLeaves = c.leaves;
    const cloud::Cloud cloud = cloud::prepare(context, c.volume, prepareOptions);
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

    std::vector<std::vector<std::int64_t>> slots;
    for (int i = 0; i < generations; ++i) slots.push_back(map.downloadSlot(i));
    const std::vector<double> masses = map.masses();
    // Sky photons all have one power; a collector is well fed by 20 of them a generation.
    const double power = sky.x * std::numbers::pi * boxSurface(cloud) / static_cast<double>(c.photons);
    const double y00 = std::sqrt(0.25 / std::numbers::pi);
    Deviations level, slope;
    RunningMean whole;
    for (std::size_t i = 0; i < masses.size(); ++i) {
        if (4.0 * std::numbers::pi * sky.x * masses[i] < 20.0 * power) continue;
        for (int k = 0; k < bands * bands; ++k) {
            // c_00 = 4π L M y_00, and y_00² = 1/4π; the other coefficients of equal light are zero
            RunningMean mean;
            for (const auto& slot : slots)
                mean.add(test::coefficient(slot, i, 0, k, bands) * map.unit() * y00 / masses[i]);
            (k == 0 ? level : slope).add(mean, k == 0 ? sky.x : 0.0);
            if (k > 0) continue;
            whole.add(mean.mean());
            // a grey cloud: channels differ by the rounding of records only
            EXPECT_NEAR(test::coefficient(slots[0], i, 1, 0, bands) * sky.x,
                        test::coefficient(slots[0], i, 0, 0, bands) * sky.y,
                        1e-4 * test::coefficient(slots[0], i, 0, 0, bands));
        }
    }
    RecordProperty(c.name + ".collectors", level.count);
    std::printf("%s: %d of %zu collectors, worst %.2f %.2f, mean z^2 %.3f %.3f, level %.5f, events %.2f M\n",
                c.name.c_str(), level.count, masses.size(), level.worst, slope.worst, level.squares.mean(),
                slope.squares.mean(), whole.mean(), static_cast<double>(counters.events) * 1e-6);
    EXPECT_GT(level.count, 40);
    level.expectNormal("level");
    slope.expectNormal("first band");
}

}  // namespace
}  // namespace lumulus::photon
