#include <cmath>
#include <utility>

#include "vdb/billowing.h"
#include "vdb/noise.h"
#include "vdb/procedural_kinds.h"

// One cell of a closed deck of stratocumulus: flat below, a low dome of billows above, thin at its rim. Cells that
// stand next to each other close the deck.
namespace lumulus::vdb {
namespace {

constexpr float kWidth = 1000.0F;
constexpr float kHeight = 250.0F;
constexpr float kMargin = 20.0F;  ///< metres left free at the sides of the box and above

/// Spheres over a disc, spread evenly (a Fibonacci spiral, Vogel 1979) and jittered: high ones in the middle.
std::vector<Puff> growCell(std::uint64_t seed) {
    constexpr float goldenAngle = 2.39996323F;
    constexpr int domes = 100;
    RandomStream random(deriveSeed(seed, 0));
    const std::uint32_t outline = deriveSeed(seed, 6);
    const float turn = random.uniform(0.0F, goldenAngle);
    std::vector<Puff> puffs;
    for (int i = 0; i < domes; ++i) {
        const float share = std::sqrt((static_cast<float>(i) + 0.5F) / domes);
        const float angle = turn + goldenAngle * static_cast<float>(i) + random.uniform(-0.3F, 0.3F);
        const glm::vec3 direction(std::cos(angle), 0.0F, std::sin(angle));
        const float side = 1.0F + 0.22F * fractalNoise(1.3F * direction, outline, 2);  // cells are no discs
        const float radius = glm::mix(96.0F, 58.0F, share * share) * random.uniform(0.8F, 1.2F);
        const float height = glm::mix(105.0F, 12.0F, share * share) * random.uniform(0.75F, 1.25F);
        puffs.push_back({(0.5F * kWidth - 90.0F) * side * share * direction + glm::vec3(0.0F, height, 0.0F), radius});
    }
    const PuffBounds bounds = boundPuffs(puffs);
    const glm::vec3 extent = bounds.high - bounds.low;
    const float scale = (kWidth - 2.0F * kMargin) / std::max(extent.x, extent.z);
    const glm::vec3 middle = 0.5F * (bounds.low + bounds.high) * glm::vec3(1.0F, 0.0F, 1.0F);
    for (Puff& puff : puffs) puff = {(puff.centre - middle) * scale, puff.radius * scale};
    return puffs;
}

}  // namespace

Volume makeStratocumulus(int resolution, std::uint64_t seed, const Report& report) {
    std::vector<Puff> puffs = growCell(seed);
    const PuffBounds bounds = boundPuffs(puffs);
    const glm::vec3 extent = bounds.high - bounds.low + 2.0F * kMargin;
    Volume volume = makeBox("stratocumulus", glm::dvec3(extent.x, kHeight, extent.z), resolution);
    fillBillowing(volume, std::move(puffs), kHeight - kMargin, seed, report);
    return volume;
}

}  // namespace lumulus::vdb
