#include <cmath>

#include "vdb/noise.h"
#include "vdb/procedural_kinds.h"

// Cirrus uncinus: ice falls from small heads and is left behind by the wind, which blows faster above.
namespace lumulus::vdb {
namespace {

constexpr float kLength = 2400.0F;
constexpr float kHeight = 600.0F;
constexpr float kDepth = 1500.0F;
constexpr float kPi = 3.14159265F;

/// A soft blob of ice: density `weight` in the middle, nothing beyond `radius`.
struct Blob {
    glm::vec3 centre{0.0F};
    float radius = 0.0F;
    float weight = 0.0F;
};

struct Hook {
    glm::vec3 head{0.0F};
    float fall = 0.0F;   ///< metres from head to tail
    float trail = 0.0F;  ///< metres by which the tail lags
    float width = 0.0F;  ///< metres across the bundle of strands
};

/// Blobs along one strand. In a linear shear ice that falls steadily lags with the square of its fall: a parabola that
/// leaves the head downwards and ends nearly level.
void growStrand(std::vector<Blob>& blobs, const Hook& hook, RandomStream& random, std::uint32_t seed, float smallest) {
    const float angle = random.uniform(0.0F, 2.0F * kPi);
    const float off = hook.width * std::sqrt(random.uniform());
    const glm::vec3 start = hook.head + glm::vec3(1.6F * off * std::cos(angle), 0.35F * off * std::sin(2.0F * angle),
                                                  off * std::sin(angle));
    const float fall = hook.fall * random.uniform(0.7F, 1.15F);
    const float trail = hook.trail * random.uniform(0.65F, 1.15F);
    const float spread = random.uniform(-70.0F, 70.0F);
    const float strength = random.uniform(0.25F, 1.0F);
    const float width = std::max(smallest, random.uniform(7.0F, 15.0F));
    const float step = 0.45F * width;
    const int steps = static_cast<int>((fall + trail) / step);
    for (int i = 0; i < steps; ++i) {
        const float t = (static_cast<float>(i) + 0.5F) / static_cast<float>(steps);
        const glm::vec3 line = start + glm::vec3(-trail * t * t, -fall * t, spread * t * t);
        const glm::vec3 wander(fractalNoise(line / 260.0F, seed, 3), fractalNoise(line / 260.0F, seed + 8U, 3),
                               fractalNoise(line / 260.0F, seed + 16U, 3));
        const float fade = smoothRamp(0.0F, 0.04F, t) * (1.0F - t);
        const float patch = smoothRamp(-0.45F, 0.2F, fractalNoise(line / 130.0F, seed + 24U, 2));
        blobs.push_back(
            {line + glm::vec3(60.0F, 26.0F, 60.0F) * wander * t, width * (1.0F + 1.3F * t), strength * fade * patch});
    }
}

/// The heads sit in loose rows along the wind (+x), each with its bundle of strands.
std::vector<Blob> growHooks(std::uint64_t seed, float smallest) {
    RandomStream random(deriveSeed(seed, 0));
    const std::uint32_t noise = deriveSeed(seed, 1);
    std::vector<Blob> blobs;
    constexpr int hooks = 20;
    constexpr int strands = 26;
    for (int i = 0; i < hooks; ++i) {
        const float row = (static_cast<float>(i) + random.uniform(0.2F, 0.8F)) / hooks;
        Hook hook;
        hook.fall = random.uniform(210.0F, 420.0F);
        hook.trail = random.uniform(620.0F, 1250.0F);
        hook.width = random.uniform(24.0F, 70.0F);
        hook.head = glm::vec3(glm::mix(-0.12F, 0.44F, random.uniform()) * kLength,
                              random.uniform(0.74F, 0.88F) * kHeight, (row - 0.5F) * 0.78F * kDepth);
        for (int j = 0; j < strands; ++j) growStrand(blobs, hook, random, noise, smallest);
    }
    return blobs;
}

/// Adds the blobs that touch slice z, in their order.
std::vector<float> sliceBlobs(const Volume& volume, const std::vector<Blob>& blobs, int z) {
    std::vector<float> sum(volume.index(0, 0, 1), 0.0F);
    const float voxel = static_cast<float>(volume.toWorld.linear[0][0]);
    const glm::vec3 origin(volume.toWorld.translation);
    const float sliceZ = voxelCentre(volume, 0, 0, z).z;
    for (const Blob& blob : blobs) {
        const float dz = sliceZ - blob.centre.z;
        if (std::abs(dz) >= blob.radius) continue;
        const int x0 = std::max(1, static_cast<int>((blob.centre.x - blob.radius - origin.x) / voxel));
        const int x1 = std::min(volume.size.x - 2, static_cast<int>((blob.centre.x + blob.radius - origin.x) / voxel));
        const int y0 = std::max(1, static_cast<int>((blob.centre.y - blob.radius - origin.y) / voxel));
        const int y1 = std::min(volume.size.y - 2, static_cast<int>((blob.centre.y + blob.radius - origin.y) / voxel));
        for (int y = y0; y <= y1; ++y) {
            for (int x = x0; x <= x1; ++x) {
                const glm::vec3 d = voxelCentre(volume, x, y, z) - blob.centre;
                const float inside = std::max(0.0F, 1.0F - glm::dot(d, d) / (blob.radius * blob.radius));
                sum[volume.index(x, y, 0)] += blob.weight * inside * inside;
            }
        }
    }
    return sum;
}

}  // namespace

Volume makeCirrus(int resolution, std::uint64_t seed, const Report& report) {
    Volume volume = makeBox("cirrus", glm::dvec3(kLength, kHeight, kDepth), resolution);
    const auto voxel = static_cast<float>(volume.toWorld.linear[0][0]);
    const std::vector<Blob> blobs = growHooks(seed, 1.1F * voxel);
    const std::uint32_t fibres = deriveSeed(seed, 2);
    fillSlices(volume, report, [&](int z) {
        const std::vector<float> ice = sliceBlobs(volume, blobs, z);
        for (int y = 1; y < volume.size.y - 1; ++y) {
            for (int x = 1; x < volume.size.x - 1; ++x) {
                const float amount = ice[volume.index(x, y, 0)];
                if (amount <= 0.0F) continue;
                const glm::vec3 p = voxelCentre(volume, x, y, z);
                const float fibre = fractalNoise(p / glm::vec3(190.0F, 45.0F, 36.0F), fibres, 4);
                const float rim = smoothRamp(0.0F, 200.0F, 0.5F * kLength - std::abs(p.x));  // no cut at the ends
                const float value = 0.35F * rim * (1.0F - std::exp(-0.16F * amount)) * smoothRamp(-0.5F, 0.35F, fibre);
                volume.density[volume.index(x, y, z)] = value > 1e-3F ? value : 0.0F;
            }
        }
    });
    return volume;
}

}  // namespace lumulus::vdb
