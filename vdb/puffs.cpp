#include "vdb/puffs.h"

#include <algorithm>
#include <cmath>

#include "vdb/noise.h"

namespace lumulus::vdb {
namespace {

constexpr float kPi = 3.14159265F;

/// One tower: spheres stacked from the ground to `height`, leaning with the wind, bulging below the top.
void stackTower(std::vector<Puff>& puffs, RandomStream& random, const glm::vec3& foot, float radius, float height) {
    const float lean = random.uniform(0.0F, 0.25F);
    float y = 0.35F * radius;
    float top = 0.0F;
    while (top < height) {
        const float rise = glm::clamp(y / height, 0.0F, 1.0F);
        const float r = radius * glm::mix(0.9F, 1.0F, std::sin(0.7F * kPi * rise)) * random.uniform(0.88F, 1.08F);
        const float sway = 0.22F * radius;
        const glm::vec3 centre =
            foot + glm::vec3(lean * y + random.uniform(-sway, sway), y, random.uniform(-sway, sway));
        puffs.push_back({centre, r});
        top = y + r;
        y += 0.62F * r;
    }
}

/// The towers: two tall ones near the middle, lower ones around them, and low puffs along the rim: a broad base.
std::vector<Puff> growTowers(RandomStream& random) {
    std::vector<Puff> puffs;
    const float side = random.uniform() < 0.5F ? -1.0F : 1.0F;
    const glm::vec3 tallest(side * random.uniform(40.0F, 110.0F), 0.0F, random.uniform(-50.0F, 50.0F));
    const glm::vec3 second(-side * random.uniform(90.0F, 170.0F), 0.0F, random.uniform(-70.0F, 70.0F));
    stackTower(puffs, random, tallest, random.uniform(165.0F, 185.0F), 600.0F);
    stackTower(puffs, random, second, random.uniform(140.0F, 165.0F), random.uniform(440.0F, 530.0F));
    constexpr int towers = 8;
    const float turn = random.uniform(0.0F, 2.0F * kPi);
    for (int i = 0; i < towers; ++i) {
        const float angle = turn + 2.0F * kPi * (static_cast<float>(i) + random.uniform(-0.3F, 0.3F)) / towers;
        const float reach = random.uniform(0.5F, 0.85F);
        const glm::vec3 foot(360.0F * reach * std::cos(angle), 0.0F, 250.0F * reach * std::sin(angle));
        const float height = 560.0F * (1.1F - 0.62F * reach) * random.uniform(0.6F, 1.3F);
        stackTower(puffs, random, foot, random.uniform(90.0F, 130.0F), height);
    }
    constexpr int rim = 13;
    for (int i = 0; i < rim; ++i) {
        const float angle = turn + 2.0F * kPi * (static_cast<float>(i) + random.uniform(-0.35F, 0.35F)) / rim;
        const float reach = random.uniform(0.8F, 1.12F);
        const float radius = random.uniform(48.0F, 92.0F);
        puffs.push_back({glm::vec3(380.0F * reach * std::cos(angle), radius * random.uniform(0.2F, 0.7F),
                                   270.0F * reach * std::sin(angle)),
                         radius});
    }
    return puffs;
}

/// True if a sphere lies so deep inside one of `hosts` that it adds nothing to the surface.
bool buried(const Puff& puff, const std::vector<Puff>& hosts) {
    return std::any_of(hosts.begin(), hosts.end(), [&](const Puff& host) {
        return glm::length(puff.centre - host.centre) + 0.75F * puff.radius < host.radius;
    });
}

/// Smaller spheres on the surface of each host, spread evenly (a Fibonacci spiral, Vogel 1979) and jittered.
std::vector<Puff> growBuds(const std::vector<Puff>& hosts, const std::vector<Puff>& all, RandomStream& random,
                           int count, float smallest, float largest) {
    constexpr float goldenAngle = 2.39996323F;
    std::vector<Puff> buds;
    for (const Puff& host : hosts) {
        const float turn = random.uniform(0.0F, 2.0F * kPi);
        for (int i = 0; i < count; ++i) {
            const float height = 1.0F - 2.0F * (static_cast<float>(i) + random.uniform()) / static_cast<float>(count);
            const float angle = turn + goldenAngle * static_cast<float>(i) + random.uniform(-0.35F, 0.35F);
            const float flat = std::sqrt(std::max(0.0F, 1.0F - height * height));
            const glm::vec3 direction(flat * std::cos(angle), height, flat * std::sin(angle));
            const float radius = host.radius * random.uniform(smallest, largest);
            const Puff bud{host.centre + direction * (host.radius * random.uniform(0.86F, 1.06F)), radius};
            if (bud.centre.y > -0.5F * radius && !buried(bud, all)) buds.push_back(bud);
        }
    }
    return buds;
}

}  // namespace

std::vector<Puff> growPuffs(std::uint64_t seed, float width) {
    RandomStream random(deriveSeed(seed, 0));
    const std::vector<Puff> towers = growTowers(random);
    std::vector<Puff> all = towers;
    const std::vector<Puff> large = growBuds(towers, all, random, 20, 0.28F, 0.5F);
    all.insert(all.end(), large.begin(), large.end());
    const std::vector<Puff> small = growBuds(large, all, random, 14, 0.26F, 0.44F);
    all.insert(all.end(), small.begin(), small.end());
    const PuffBounds bounds = boundPuffs(all);
    const glm::vec3 extent = bounds.high - bounds.low;
    const float scale = width / std::max(extent.x, extent.z);
    const glm::vec3 middle = 0.5F * (bounds.low + bounds.high) * glm::vec3(1.0F, 0.0F, 1.0F);
    for (Puff& puff : all) puff = {(puff.centre - middle) * scale, puff.radius * scale};
    return all;
}

PuffBounds boundPuffs(const std::vector<Puff>& puffs) {
    PuffBounds bounds;
    for (const Puff& puff : puffs) {
        bounds.low = glm::min(bounds.low, puff.centre - puff.radius);
        bounds.high = glm::max(bounds.high, puff.centre + puff.radius);
    }
    return bounds;
}

}  // namespace lumulus::vdb
