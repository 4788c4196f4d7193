// The photon walk against published plane-parallel layers: Stamnes et al. 1988 (DISORT's test problems), van de Hulst
// 1980, and adding-doubling; and against what is known exactly.
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "light/photon/slab.h"
#include "support/vulkan_fixture.h"

namespace lumulus::photon {
namespace {

constexpr std::uint64_t photons = 400000;
/// |z| of one comparison; 20 comparisons exceed it by chance once in 1e3 suites.
constexpr double bound = 4.2;

struct Layer {
    const char* name;
    double g, tau, albedo, mu0;
    double reflected, diffuse, direct;  // negative: not given by the source
};

class SlabTest : public test::VulkanTest, public testing::WithParamInterface<Layer> {};

Slab slabOf(const Layer& layer, std::uint64_t seed) {
    Slab slab{layer.tau, layer.albedo, layer.mu0, {}, photons, seed};
    slab.phase.g = layer.g;
    return slab;
}

void expectFraction(const SlabFraction& found, double expected, const char* what) {
    if (expected < 0.0) return;
    if (found.standardError > 0.0)
        EXPECT_LT(std::abs(found.value - expected) / found.standardError, bound) << what << " " << found.value;
    else
        EXPECT_NEAR(found.value, expected, 1.0 / static_cast<double>(photons)) << what;
}

TEST_P(SlabTest, AgreesWithThePublishedAnswer) {
    const Layer& layer = GetParam();
    const SlabResult result = traceSlab(context, slabOf(layer, 7));
    expectFraction(result.reflected, layer.reflected, "reflected");
    expectFraction(result.transmittedDiffuse, layer.diffuse, "transmitted diffusely");
    expectFraction(result.transmittedDirect, layer.direct, "transmitted directly");
    EXPECT_EQ(result.lost, 0U);
    EXPECT_NEAR(result.reflected.value + result.transmittedDiffuse.value + result.transmittedDirect.value +
                    result.absorbed.value,
                1.0, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Published, SlabTest,
                         testing::Values(Layer{"thin_grazing_absorbing", 0.0, 0.03125, 0.2, 0.1, 0.0254473, 0.0252772,
                                               0.731616},
                                         Layer{"thin_grazing", 0.0, 0.03125, 1.0, 0.1, 0.1346202, 0.1337643, 0.731616},
                                         Layer{"thick_absorbing", 0.0, 32.0, 0.2, 0.1, 0.0826606, 0.0, 0.0},
                                         Layer{"thick", 0.0, 32.0, 1.0, 0.1, 0.9784527, 0.0215481, 0.0},
                                         Layer{"forward", 0.75, 1.0, 1.0, 1.0, 0.0787416, 0.5533786, 0.3678794},
                                         Layer{"van_de_hulst", 0.75, 2.0, 0.9, 1.0, 0.09739, 0.525625, 0.1353353},
                                         Layer{"cloud", 0.85, 4.0, 1.0, 1.0, 0.19091, -1.0, 0.0183156},
                                         Layer{"thick_cloud", 0.85, 16.0, 0.99, 1.0, 0.41772, 0.30610, 0.0},
                                         Layer{"sharp_forward", 0.99, 16.0, 1.0, 1.0, 0.04099, -1.0, 0.0}),
                         [](const auto& layer) { return std::string(layer.param.name); });

using SlabLimits = test::VulkanTest;

TEST_F(SlabLimits, NothingIsThereAtThicknessZero) {
    const SlabResult result = traceSlab(context, slabOf({"", 0.85, 0.0, 1.0, 0.5, 0, 0, 0}, 1));
    EXPECT_EQ(result.transmittedDirect.value, 1.0);
    EXPECT_EQ(result.events, 0U);
}

TEST_F(SlabLimits, BlackMatterOnlyAttenuates) {
    const SlabResult result = traceSlab(context, slabOf({"", 0.85, 1.5, 0.0, 0.6, 0, 0, 0}, 2));
    EXPECT_EQ(result.reflected.value, 0.0);
    EXPECT_EQ(result.transmittedDiffuse.value, 0.0);
    expectFraction(result.transmittedDirect, std::exp(-1.5 / 0.6), "transmitted directly");
}

TEST_F(SlabLimits, AVeryThickLayerReflectsEverything) {
    Slab slab = slabOf({"", 0.0, 1e6, 1.0, 1.0, 0, 0, 0}, 3);
    slab.photons = 256;
    const SlabResult result = traceSlab(context, slab);
    // diffusion: T ≈ (1 + 2/3·…)/(τ + 1.42) ≈ 1.7e-6 for isotropic scattering, far below one photon in 256
    EXPECT_EQ(result.transmittedDiffuse.value, 0.0);
    EXPECT_NEAR(result.reflected.value + static_cast<double>(result.lost) / 256.0, 1.0, 1e-12);
}

TEST_F(SlabLimits, BadValuesAreRefused) {
    EXPECT_THROW(traceSlab(context, slabOf({"", 0.85, -1.0, 1.0, 1.0, 0, 0, 0}, 1)), InputError);
    EXPECT_THROW(traceSlab(context, slabOf({"", 0.85, 1.0, 1.1, 1.0, 0, 0, 0}, 1)), InputError);
    EXPECT_THROW(traceSlab(context, slabOf({"", 0.85, 1.0, 1.0, 0.0, 0, 0, 0}, 1)), InputError);
    EXPECT_THROW(traceSlab(context, slabOf({"", 1.0, 1.0, 1.0, 1.0, 0, 0, 0}, 1)), InputError);
}

}  // namespace
}  // namespace lumulus::photon
