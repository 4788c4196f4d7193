#include "prefilter/cone.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <numbers>

#include "prefilter/prefilter.h"
#include "shared/rng.h"

namespace lumulus::prefilter {

namespace {

constexpr std::uint32_t samples = 200;  // the thesis sees no gain beyond (figure 4.15)

}  // namespace

std::vector<glm::vec3> coneMeans(const CubeMap& map, double angle, std::span<const glm::vec3> directions,
                                 const Check& check) {
    using std::numbers::pi;
    std::vector<glm::vec3> values(directions.size());
    const auto radius = static_cast<float>(std::tan(angle * pi / 180.0));
    const std::uint32_t stream = shared::rngStream(1U, 0U, 0U);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, directions.size(), 64), [&](const auto& range) {
        check();
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
            const glm::mat3 frame = frameOf(directions[i]);
            glm::vec3 sum(0.0F);
            float weights = 0.0F;
            for (std::uint32_t k = 0; k < (radius > 0.0F ? samples : 1U); ++k) {
                const glm::vec4 u = shared::rngUniform4({static_cast<std::uint32_t>(i), k, 0U, stream});
                const float r = radius * std::sqrt(u.x), around = 2.0F * std::numbers::pi_v<float> * u.y;
                const glm::vec3 towards = glm::normalize(glm::vec3(r * std::cos(around), r * std::sin(around), 1.0F));
                sum += towards.z * map.at(frame * towards, 0.0F);
                weights += towards.z;
            }
            values[i] = sum / weights;
        }
    });
    return values;
}

}  // namespace lumulus::prefilter
