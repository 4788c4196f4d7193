#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <vector>

#include "gpu/commands.h"
#include "gpu/transfer.h"
#include "shared/rng.h"
#include "shared/sh.h"
#include "stat/maths_programs.h"
#include "support/vulkan_fixture.h"

namespace lumulus {
namespace {

using SphericalHarmonicsOnGpu = test::VulkanTest;

/// The number of bands is a specialisation constant.
TEST_F(SphericalHarmonicsOnGpu, AreThoseOfTheHost) {
    constexpr std::uint32_t count = 4096;
    std::vector<glm::vec3> directions;
    for (std::uint32_t i = 0; i < count; ++i) {
        const glm::vec4 u = shared::rngUniform4({i, 0U, 0U, 3U});
        directions.push_back(glm::normalize(glm::vec3(u) - 0.5F));
    }
    gpu::Buffer input(context, "directions", count * sizeof(glm::vec3), gpu::Memory::device);
    gpu::upload(context, input, directions);
    for (int bands = 1; bands <= shared::shMaxBands; ++bands) {
        const gpu::Program<gpu::NoPush> program(context, "evaluate_sh", test::evaluate_sh_comp,
                                                {gpu::SpecConstant::of(0, bands)});
        const auto size = static_cast<std::size_t>(bands) * static_cast<std::size_t>(bands);
        const gpu::Buffer output(context, "coefficients", count * size * sizeof(float), gpu::Memory::device);
        gpu::Commands commands(context);
        commands.begin();
        commands.pass("evaluate");
        commands.dispatch(program, {{"Directions", input}, {"Coefficients", output}}, {}, {count / 64, 1, 1});
        commands.submit();
        commands.wait();
        const std::vector<float> found = gpu::download<float>(context, output);
        float worst = 0.0F;
        for (std::size_t i = 0; i < count; ++i) {
            float y[shared::shMaxCoefficients];
            shared::shEvaluate(bands, directions[i], y);
            for (std::size_t k = 0; k < size; ++k) {
                worst = std::max(worst, std::abs(found[i * size + k] - y[k]));
            }
        }
        EXPECT_LT(worst, 1e-5F) << bands << " bands";
    }
}

}  // namespace
}  // namespace lumulus
