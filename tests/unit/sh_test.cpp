#include "shared/sh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>
#include <vector>

#include "medium/phase_function.h"
#include "medium/quadrature.h"
#include "shared/rng.h"
#include "support/phase_cases.h"

namespace lumulus {
namespace {

using std::numbers::pi;
using test::PhaseCase;
using Coefficients = std::array<double, shared::shMaxCoefficients>;

/// The float code, as doubles.
Coefficients evaluate(const glm::dvec3& d) {
    float y[shared::shMaxCoefficients];
    shared::shEvaluate(shared::shMaxBands, shared::vec3(d), y);
    Coefficients values{};
    for (std::size_t i = 0; i < values.size(); ++i) {
        values[i] = static_cast<double>(y[i]);
    }
    return values;
}

/// From the definition: y_lm = √((2l+1)/4π (l−m)!/(l+m)!) P_l^m(cos θ) · (√2 cos mφ | 1 | √2 sin |m|φ).
Coefficients evaluateByDefinition(const glm::dvec3& d) {
    Coefficients values{};
    const double phi = std::atan2(d.y, d.x);
    for (int l = 0; l < shared::shMaxBands; ++l) {
        for (int m = -l; m <= l; ++m) {
            const int order = std::abs(m);
            const double ratio = std::tgamma(l - order + 1) / std::tgamma(l + order + 1);
            const double norm = std::sqrt((2 * l + 1) / (4.0 * pi) * ratio);
            // std::assoc_legendre leaves the Condon–Shortley phase out
            const double legendre = std::assoc_legendre(static_cast<unsigned>(l), static_cast<unsigned>(order), d.z);
            const double azimuth =
                m == 0 ? 1.0 : std::numbers::sqrt2 * (m > 0 ? std::cos(order * phi) : std::sin(order * phi));
            values[static_cast<std::size_t>(l * (l + 1) + m)] = norm * legendre * azimuth;
        }
    }
    return values;
}

glm::dvec3 direction(double cosTheta, double phi) {
    const double sine = std::sqrt(1.0 - cosTheta * cosTheta);
    return {sine * std::cos(phi), sine * std::sin(phi), cosTheta};
}

/// ∫ f dω: 16-point Gauss–Legendre in z on each half, 32 azimuths; exact for products of two harmonics of 8 bands.
template <typename Function>
void integrateDirections(const Function& f) {
    const phase::GaussRule& rule = phase::gaussRule();
    for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
        for (const double half : {-0.5, 0.5}) {
            for (int k = 0; k < 32; ++k) {
                const glm::dvec3 d = direction(half + 0.5 * rule.nodes[i], (k + 0.5) * pi / 16.0);
                f(d, 0.5 * rule.weights[i] * pi / 16.0);
            }
        }
    }
}

glm::dvec3 randomDirection(std::uint32_t i) {
    const shared::vec4 u = shared::rngUniform4(shared::uvec4(i, 0U, 0U, 77U));
    return direction(2.0 * static_cast<double>(u.x) - 1.0, 2.0 * pi * static_cast<double>(u.y));
}

TEST(SphericalHarmonics, AgreeWithTheDefinition) {
    for (std::uint32_t i = 0; i < 2000; ++i) {
        const glm::dvec3 d = randomDirection(i);
        const Coefficients found = evaluate(d);
        const Coefficients exact = evaluateByDefinition(d);
        for (std::size_t k = 0; k < found.size(); ++k) {
            ASSERT_NEAR(found[k], exact[k], 4e-6) << "coefficient " << k;
        }
    }
}

TEST(SphericalHarmonics, FirstBandsAreTheUsualOnes) {
    const glm::dvec3 d = glm::normalize(glm::dvec3(0.3, -0.5, 0.7));
    const Coefficients y = evaluate(d);
    EXPECT_NEAR(y[0], 0.282095, 1e-6);
    EXPECT_NEAR(y[1], 0.488603 * d.y, 1e-6);
    EXPECT_NEAR(y[2], 0.488603 * d.z, 1e-6);
    EXPECT_NEAR(y[3], 0.488603 * d.x, 1e-6);
    EXPECT_NEAR(y[4], 1.092548 * d.x * d.y, 1e-6);
    EXPECT_NEAR(y[6], 0.315392 * (3.0 * d.z * d.z - 1.0), 1e-6);
    EXPECT_NEAR(y[8], 0.546274 * (d.x * d.x - d.y * d.y), 1e-6);
}

TEST(SphericalHarmonics, AreOrthonormal) {
    std::vector<Coefficients> products(shared::shMaxCoefficients, Coefficients{});
    integrateDirections([&](const glm::dvec3& d, double weight) {
        const Coefficients y = evaluate(d);
        for (std::size_t i = 0; i < y.size(); ++i) {
            for (std::size_t j = 0; j < y.size(); ++j) {
                products[i][j] += weight * y[i] * y[j];
            }
        }
    });
    for (std::size_t i = 0; i < products.size(); ++i) {
        for (std::size_t j = 0; j < products.size(); ++j) {
            EXPECT_NEAR(products[i][j], i == j ? 1.0 : 0.0, 1e-6) << i << ", " << j;
        }
    }
}

TEST(SphericalHarmonics, FewerBandsAreTheSameNumbersAndTouchNothingElse) {
    const shared::vec3 d(glm::normalize(glm::dvec3(-0.2, 0.9, 0.4)));
    float all[shared::shMaxCoefficients];
    shared::shEvaluate(shared::shMaxBands, d, all);
    for (int bands = 1; bands <= shared::shMaxBands; ++bands) {
        float some[shared::shMaxCoefficients];
        std::fill(std::begin(some), std::end(some), -99.0F);
        shared::shEvaluate(bands, d, some);
        for (int i = 0; i < shared::shMaxCoefficients; ++i) {
            EXPECT_EQ(some[i], i < bands * bands ? all[i] : -99.0F) << bands << " bands, coefficient " << i;
        }
    }
}

/// max(0, d·n): c_lm = A_l y_lm(n), A_0..A_4 = π, 2π/3, π/4, 0, −π/24, A_6 = π/64 (Ramamoorthi and Hanrahan 2001).
TEST(SphericalHarmonics, ProjectAndReconstructAClampedCosine) {
    const std::array<double, 8> known{pi, 2.0 * pi / 3.0, pi / 4.0, 0.0, -pi / 24.0, 0.0, pi / 64.0, 0.0};
    Coefficients projected{};
    integrateDirections([&](const glm::dvec3& d, double weight) {
        const Coefficients y = evaluate(d);
        for (std::size_t i = 0; i < y.size(); ++i) {
            projected[i] += weight * std::max(d.z, 0.0) * y[i];
        }
    });
    const Coefficients pole = evaluateByDefinition({0.0, 0.0, 1.0});
    for (int l = 0; l < shared::shMaxBands; ++l) {
        for (int m = -l; m <= l; ++m) {
            const auto i = static_cast<std::size_t>(l * (l + 1) + m);
            EXPECT_NEAR(projected[i], known[static_cast<std::size_t>(l)] * pole[i], 2e-6) << l << ", " << m;
        }
    }
    for (std::uint32_t k = 0; k < 200; ++k) {
        const glm::dvec3 d = randomDirection(k);
        const Coefficients y = evaluate(d);
        double sum = 0.0;
        for (std::size_t i = 0; i < y.size(); ++i) {
            sum += projected[i] * y[i];
        }
        EXPECT_NEAR(sum, std::max(d.z, 0.0), 0.045);  // 4 % is what 8 bands leave at the kink
    }
}

class FunkHecke : public ::testing::TestWithParam<PhaseCase> {};

/// Scattering a field by p is a product with χ_l: ∫ p(ω·ω') f(ω') dω' = Σ χ_l c_lm y_lm(ω).
TEST_P(FunkHecke, ConvolutionIsDiagonal) {
    const phase::PhaseFunction p(GetParam().phase);
    const std::vector<double> moments = p.moments(shared::shMaxBands);
    Coefficients field{};
    for (std::size_t i = 0; i < field.size(); ++i) {
        const auto key = static_cast<std::uint32_t>(i);
        field[i] = static_cast<double>(shared::rngUniform4(shared::uvec4(key, 0U, 0U, 5U)).x) - 0.5;
    }
    const auto evaluateField = [&field](const glm::dvec3& d) {
        const Coefficients y = evaluate(d);
        double sum = 0.0;
        for (std::size_t i = 0; i < y.size(); ++i) {
            sum += field[i] * y[i];
        }
        return sum;
    };
    for (std::uint32_t k = 0; k < 5; ++k) {
        const glm::dvec3 d = randomDirection(k);
        const glm::dvec3 side = glm::normalize(glm::cross(d, glm::dvec3(0.1, 0.3, -0.9)));
        const glm::dvec3 other = glm::cross(d, side);
        const double scattered = test::integrateSphere(
            [&](double theta) {
                double ring = 0.0;
                for (int n = 0; n < 16; ++n) {
                    const double phi = n * pi / 8.0;
                    ring += evaluateField(std::cos(theta) * d +
                                          std::sin(theta) * (std::cos(phi) * side + std::sin(phi) * other));
                }
                return p.evaluateAngle(theta) * ring / 16.0;
            },
            0.0, pi, p.lobeWidth());
        const Coefficients y = evaluateByDefinition(d);
        double expected = 0.0;
        for (int l = 0; l < shared::shMaxBands; ++l) {
            for (int i = l * l; i < (l + 1) * (l + 1); ++i) {
                const auto slot = static_cast<std::size_t>(i);
                expected += moments[static_cast<std::size_t>(l)] * field[slot] * y[slot];
            }
        }
        EXPECT_NEAR(scattered, expected, 1e-5);
    }
}

INSTANTIATE_TEST_SUITE_P(SphericalHarmonics, FunkHecke, ::testing::ValuesIn(test::allCases()));

}  // namespace
}  // namespace lumulus
