// Coefficients at the fixed-point limit: the unit of the ring is that of the first generation's lights, and later
// lights may be far brighter. Saturation is counted, and no number wraps.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "light/photon/photon_map.h"
#include "support/cloud_cases.h"
#include "support/photon_setup.h"
#include "support/vulkan_fixture.h"

namespace lumulus::photon {
namespace {

constexpr int bands = 2;
/// Beyond it the accumulation clamps (shaders/photon/accumulate.comp).
constexpr std::int64_t limit = (std::int64_t{1} << 61) - 1;

class Saturation : public test::VulkanTest {
  protected:
    cloud::Asset cloud = cloud::prepare(context, ballVolume(18, 20.0), test::prepareOptions(400));
    PhotonMap map{context, cloud, test::mediumOf({.extinction = 0.1, .bands = bands}),
                  test::mapOptions(3000, 2, bands)};

    void traceSky(double radiance) { map.trace(test::noSun(), test::skyOf(glm::dvec3(radiance))); }

    /// Of the coefficients c_00, which are positive.
    std::pair<std::int64_t, std::int64_t> rangeOfLevels() {
        const std::vector<std::int64_t> sum = map.downloadSum();
        std::int64_t least = sum[0], most = sum[0];
        for (std::size_t i = 0; i < sum.size(); i += bands * bands) {
            least = std::min(least, sum[i]);
            most = std::max(most, sum[i]);
        }
        return {least, most};
    }
};

TEST_F(Saturation, BrighterLightsThanTheUnitHoldsAreClampedAndCounted) {
    traceSky(1.0);
    EXPECT_EQ(map.counters().saturated, 0U);
    EXPECT_LT(rangeOfLevels().second, limit);
    for (int i = 0; i < 3; ++i) {
        traceSky(1e9);
        EXPECT_GE(rangeOfLevels().first, 0) << "a positive coefficient wrapped";
        EXPECT_EQ(rangeOfLevels().second, limit);
    }
    EXPECT_GT(map.counters().saturated, 0U);
    for (const std::int64_t value : map.downloadSum()) EXPECT_LE(std::abs(value), limit);
}

/// Light that is brighter by a factor that the unit has room for (2¹⁹ of the first flux) stays exact.
TEST_F(Saturation, BrighterLightsWithinTheRoomAreExact) {
    traceSky(1.0);
    traceSky(1e4);
    EXPECT_EQ(map.counters().saturated, 0U);
    const std::vector<std::int64_t> dim = map.downloadSlot(0), bright = map.downloadSlot(1), sum = map.downloadSum();
    for (std::size_t i = 0; i < sum.size(); ++i) ASSERT_EQ(sum[i], dim[i] + bright[i]);
    EXPECT_GT(rangeOfLevels().second, *std::max_element(dim.begin(), dim.end()));
}

}  // namespace
}  // namespace lumulus::photon
