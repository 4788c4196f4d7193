#include "reference/slab.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>

#include "base/error.h"

namespace lumulus::reference {
namespace {

/// A layer whose answer is known; what the source does not give is absent.
struct Known {
    const char* name;
    double g, tau, albedo, mu0;
    double reflected;
    std::optional<double> transmittedDiffuse;
    double transmittedDirect;
};

/// DISORT's test problems (Stamnes et al. 1988), van de Hulst 1980, and adding-doubling to 2e-5.
const Known knownLayers[] = {
    {"disort-1a", 0.0, 0.03125, 0.2, 0.1, 0.0254473, 0.0252772, 0.731616},
    {"disort-1b", 0.0, 0.03125, 1.0, 0.1, 0.1346202, 0.1337643, 0.731616},
    {"disort-1d", 0.0, 32.0, 0.2, 0.1, 0.0826606, 0.0, 0.0},
    {"disort-1e", 0.0, 32.0, 1.0, 0.1, 0.9784527, 0.0215481, 0.0},
    {"disort-3a", 0.75, 1.0, 1.0, 1.0, 0.0787416, 0.5533786, 0.3678794},
    {"van-de-hulst", 0.75, 2.0, 0.9, 1.0, 0.09739, 0.525625, 0.1353353},
    {"adding-doubling-a", 0.85, 4.0, 1.0, 1.0, 0.19091, {}, 0.0183156},
    {"adding-doubling-b", 0.85, 16.0, 0.99, 1.0, 0.41772, 0.30610, 0.0},
    {"adding-doubling-c", 0.99, 16.0, 1.0, 1.0, 0.04099, {}, 0.0},
};

Slab slabOf(const Known& known, std::uint64_t photons) {
    Slab slab;
    slab.tau = known.tau;
    slab.phase.g = known.g;
    slab.albedo = known.albedo;
    slab.mu0 = known.mu0;
    slab.photons = photons;
    slab.seed = 20;
    return slab;
}

/// |z| < 4 on top of `digits`, how well the source itself is known.
void expectAgreement(const Estimate& estimate, double expected, double digits) {
    EXPECT_LE(std::abs(estimate.value - expected), 4.0 * estimate.standardError + digits);
}

class KnownSlab : public testing::TestWithParam<Known> {};

TEST_P(KnownSlab, AgreesWithTheLiterature) {
    const Known& known = GetParam();
    const SlabResult result = solveSlab(slabOf(known, 400'000));
    constexpr double digits = 2e-5;
    EXPECT_LT(result.reflected.standardError, 1e-3);
    expectAgreement(result.reflected, known.reflected, digits);
    expectAgreement(result.transmittedDirect, known.transmittedDirect, 1e-6);
    if (known.transmittedDiffuse) {
        expectAgreement(result.transmittedDiffuse, *known.transmittedDiffuse, digits);
    }
    EXPECT_NEAR(result.reflected.value + result.transmittedDiffuse.value + result.transmittedDirect.value +
                    result.absorbed.value,
                1.0, 1e-12);
    if (known.albedo == 1.0) {
        EXPECT_NEAR(result.absorbed.value, 0.0, 1e-12);
    }
}

INSTANTIATE_TEST_SUITE_P(Literature, KnownSlab, testing::ValuesIn(knownLayers),
                         [](const testing::TestParamInfo<Known>& row) {
                             std::string name = row.param.name;
                             std::erase(name, '-');
                             return name;
                         });

/// With albedo a → 0 only one scattering counts: isotropic, R = a/(2μ0) ∫∫ e^{−t/μ0 − t/μ} dt dμ.
TEST(Slab, SingleScatteringAgreesWithQuadrature) {
    Slab slab;
    slab.tau = 0.7;
    slab.phase.g = 0.0;
    slab.albedo = 1e-4;
    slab.mu0 = 0.6;
    slab.photons = 4'000'000;
    const SlabResult result = solveSlab(slab);
    double reflected = 0.0, transmitted = 0.0;
    constexpr int steps = 20001;  // odd: no midpoint at μ = μ0
    for (int i = 0; i < steps; ++i) {
        const double mu = (i + 0.5) / steps;
        const double both = 1.0 / slab.mu0 + 1.0 / mu;
        const double difference = 1.0 / slab.mu0 - 1.0 / mu;
        const double direct = std::exp(-slab.tau / slab.mu0), down = std::exp(-slab.tau / mu);
        reflected += 0.5 * slab.albedo / slab.mu0 * (1.0 - std::exp(-slab.tau * both)) / both / steps;
        transmitted += 0.5 * slab.albedo / slab.mu0 * (down - direct) / difference / steps;
    }
    EXPECT_LT(result.reflected.standardError, 0.1 * reflected);
    expectAgreement(result.reflected, reflected, 1e-4 * reflected);
    expectAgreement(result.transmittedDiffuse, transmitted, 1e-4 * transmitted);
}

TEST(Slab, GivesTheSameBitsAgain) {
    const Slab slab = slabOf(knownLayers[4], 20'000);
    EXPECT_EQ(solveSlab(slab).reflected.value, solveSlab(slab).reflected.value);
    Slab other = slab;
    other.seed = 21;
    EXPECT_NE(solveSlab(slab).reflected.value, solveSlab(other).reflected.value);
}

TEST(Slab, NoLayerLetsEverythingThrough) {
    Slab slab;
    slab.tau = 0.0;
    slab.photons = 100;
    const SlabResult result = solveSlab(slab);
    EXPECT_EQ(result.transmittedDirect.value, 1.0);
    EXPECT_EQ(result.reflected.value, 0.0);
    EXPECT_EQ(result.absorbed.value, 0.0);
}

TEST(Slab, RefusesWhatIsOutOfRange) {
    Slab slab;
    slab.mu0 = 0.0;
    EXPECT_THROW(solveSlab(slab), InputError);
    slab = {};
    slab.albedo = 1.1;
    EXPECT_THROW(solveSlab(slab), InputError);
    slab = {};
    slab.tau = -1.0;
    EXPECT_THROW(solveSlab(slab), InputError);
    slab = {};
    slab.phase.g = 1.0;
    EXPECT_THROW(solveSlab(slab), InputError);
    slab = {};
    slab.photons = 0;
    EXPECT_THROW(solveSlab(slab), InputError);
}

}  // namespace
}  // namespace lumulus::reference
