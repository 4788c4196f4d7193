#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <vector>

#include "gpu/commands.h"
#include "gpu/transfer.h"
#include "shared/phase.h"
#include "shared/rng.h"
#include "stat/maths_programs.h"
#include "stat/shaders/sample_hg.h"
#include "support/angle_distribution.h"
#include "support/vulkan_fixture.h"

namespace lumulus {
namespace {

using shared::SampledDirection;
using shared::SampleHgPush;

constexpr std::uint32_t samples = 1U << 20U;
const std::uint32_t stream = shared::rngStream(20240502U, 0U, 0U);

class HgSampler : public test::VulkanTest, public testing::WithParamInterface<test::PhaseCase> {
  protected:
    std::vector<SampledDirection> sample(const glm::vec3& from, double cut) {
        const phase::PhaseFunction p(GetParam().phase);
        const gpu::Program<SampleHgPush> program(context, "sample_hg", test::sample_hg_comp);
        const gpu::Buffer turns(context, "turns", samples * sizeof(SampledDirection), gpu::Memory::device);
        gpu::Commands commands(context);
        const SampleHgPush push{from, static_cast<float>(GetParam().phase.g),
                                static_cast<float>(1.0 - p.forwardFraction(cut)), stream, samples};
        commands.begin();
        commands.pass("sample");
        commands.dispatch(program, {{"Turns", turns}}, push, {samples / 64, 1, 1});
        commands.submit();
        commands.wait();
        return gpu::download<SampledDirection>(context, turns);
    }
};

TEST_P(HgSampler, DistributionIsThatOfThePhaseFunction) {
    const phase::PhaseFunction p(GetParam().phase);
    for (const double cut : {0.0, 12.0 * test::degree}) {
        test::AngleDistribution distribution(p, cut);
        for (const SampledDirection& turn : sample({0.0F, 0.0F, 1.0F}, cut)) {
            distribution.add(shared::ScatterAngle(turn.angle.x, turn.angle.y, turn.angle.z));
        }
        distribution.expectAgreement();
    }
}

TEST_P(HgSampler, RandomNumbersAreThoseOfTheHostAndTurnsAreTrue) {
    const glm::dvec3 from = glm::normalize(glm::dvec3(0.3, -0.5, -0.8));
    std::uint32_t index = 0;
    std::uint32_t different = 0;
    double longest = 0.0;
    double farthest = 0.0;
    for (const SampledDirection& turn : sample(glm::vec3(from), 0.0)) {
        different += turn.uniform4 == shared::rngUniform4({index++, 0U, 0U, stream}) ? 0U : 1U;
        const glm::dvec3 to(turn.to);
        longest = std::max(longest, std::abs(glm::length(to) - 1.0));
        const double theta = 2.0 * std::atan2(glm::length(to - from), glm::length(to + from));
        const double asked = test::thetaOf(shared::ScatterAngle(turn.angle.x, turn.angle.y, turn.angle.z));
        farthest = std::max(farthest, std::abs(theta - asked));
    }
    EXPECT_EQ(different, 0U);
    EXPECT_LT(longest, 1e-6);
    EXPECT_LT(farthest, 2e-6);
}

INSTANTIATE_TEST_SUITE_P(Phase, HgSampler, testing::ValuesIn(test::hgCases()));

}  // namespace
}  // namespace lumulus
