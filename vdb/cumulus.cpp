#include <cmath>
#include <utility>

#include "vdb/noise.h"
#include "vdb/procedural_kinds.h"
#include "vdb/puffs.h"

// A cumulus: a cauliflower of spheres, its surface roughened by billows and cut flat at the condensation level.
namespace lumulus::vdb {
namespace {

constexpr float kWidth = 1000.0F;
constexpr float kHeight = 650.0F;
constexpr float kRoughness = 26.0F;  ///< metres: how far billows and warp can move the surface
constexpr float kMargin = 20.0F;     ///< metres left free at the sides of the box

struct Seeds {
    std::uint32_t warp, billow, wisp, inside, base;
};

class Cumulus {
  public:
    Cumulus(Volume& volume, std::vector<Puff> puffs, std::uint64_t seed) : volume_(volume), puffs_(std::move(puffs)) {
        seeds_ = {deriveSeed(seed, 1), deriveSeed(seed, 2), deriveSeed(seed, 3), deriveSeed(seed, 4),
                  deriveSeed(seed, 5)};
        stretch_ = boundPuffs(puffs_).high.y / (kHeight - kMargin);
        voxel_ = static_cast<float>(volume.toWorld.linear[0][0]);
    }

    void fillSlice(int z) const {
        const std::vector<glm::vec3> warped = warpSlice(z);
        const std::vector<float> distance = slicePuffs(warped, z);
        for (int y = 1; y < volume_.size.y - 1; ++y) {
            for (int x = 1; x < volume_.size.x - 1; ++x) {
                const glm::vec3 point = voxelCentre(volume_, x, y, z);
                volume_.density[volume_.index(x, y, z)] = density(point, distance[volume_.index(x, y, 0)]);
            }
        }
    }

  private:
    /// The points of a slice in the space of the puffs, warped so that no sphere is visible as such.
    std::vector<glm::vec3> warpSlice(int z) const {
        constexpr float bend = 24.0F;
        constexpr float size = 80.0F;
        std::vector<glm::vec3> points(volume_.index(0, 0, 1));
        for (int y = 0; y < volume_.size.y; ++y) {
            for (int x = 0; x < volume_.size.x; ++x) {
                const glm::vec3 p = voxelCentre(volume_, x, y, z);
                const glm::vec3 q = p / size;
                const glm::vec3 shift(fractalNoise(q, seeds_.warp, 2), fractalNoise(q, seeds_.warp + 2U, 2),
                                      fractalNoise(q, seeds_.warp + 4U, 2));
                points[volume_.index(x, y, 0)] = glm::vec3(p.x, p.y * stretch_, p.z) + bend * shift;
            }
        }
        return points;
    }

    /// Signed distance to the union of the puffs: exact below kRoughness, elsewhere at least that large.
    std::vector<float> slicePuffs(const std::vector<glm::vec3>& warped, int z) const {
        constexpr float reach = 2.0F * kRoughness + 18.0F;  // the warp moves points by at most 24·3/4 m
        std::vector<float> distance(warped.size(), kRoughness);
        const float sliceZ = voxelCentre(volume_, 0, 0, z).z;
        const glm::vec3 origin(volume_.toWorld.translation);
        for (const Puff& puff : puffs_) {
            const float r = puff.radius + reach;
            if (std::abs(puff.centre.z - sliceZ) > r) continue;
            const float middleY = puff.centre.y / stretch_;
            const int x0 = std::max(1, static_cast<int>((puff.centre.x - r - origin.x) / voxel_));
            const int x1 = std::min(volume_.size.x - 2, static_cast<int>((puff.centre.x + r - origin.x) / voxel_));
            const int y0 = std::max(1, static_cast<int>((middleY - r - origin.y) / voxel_));
            const int y1 = std::min(volume_.size.y - 2, static_cast<int>((middleY + r - origin.y) / voxel_));
            for (int y = y0; y <= y1; ++y) {
                for (int x = x0; x <= x1; ++x) {
                    const std::size_t i = volume_.index(x, y, 0);
                    distance[i] = std::min(distance[i], glm::length(warped[i] - puff.centre) - puff.radius);
                }
            }
        }
        return distance;
    }

    /// Billows of three sizes [m]: round outwards, creased inwards. Sizes below two voxels are left out.
    float billows(const glm::vec3& point) const {
        float sum = 0.0F;
        float size = 42.0F;
        for (std::uint32_t octave = 0; octave < 4U; ++octave) {
            if (size < 2.0F * voxel_ && octave > 0U) break;
            sum += 0.38F * size * (billowNoise(point / size, seeds_.billow + octave) - 0.72F);
            size *= 0.48F;
        }
        return sum;
    }

    float density(const glm::vec3& point, float distance) const {
        if (distance >= kRoughness) return 0.0F;
        const float edge = std::max(9.0F, 1.3F * voxel_);
        if (distance > -kRoughness - edge) {
            distance -= billows(point);
            // entrainment frays the flanks near the base; the growing tops stay crisp
            const float fray = glm::mix(12.0F, 6.0F, smoothRamp(0.0F, 260.0F, point.y));
            distance += fray * (fractalNoise(point / 34.0F, seeds_.wisp, 4) + 0.25F);
        }
        const float surface = smoothRamp(-0.5F, 0.5F, -distance / edge);  // centred: the mass does not depend on it
        if (surface <= 0.0F) return 0.0F;
        const float ground = 9.0F + 11.0F * fractalNoise(glm::vec3(point.x, 0.0F, point.z) / 90.0F, seeds_.base, 3);
        const float base = smoothRamp(ground - 8.0F, ground + 14.0F, point.y);
        // liquid water grows with height above the base, less than adiabatically (Warner 1955)
        const float height = glm::mix(0.55F, 1.0F, std::sqrt(glm::clamp(point.y / (0.6F * kHeight), 0.0F, 1.0F)));
        const float texture = 0.92F + 0.16F * fractalNoise(point / 70.0F, seeds_.inside, 3);
        return glm::clamp(surface * base * height * texture, 0.0F, 1.0F);
    }

    Volume& volume_;
    std::vector<Puff> puffs_;
    Seeds seeds_{};
    float stretch_ = 1.0F;  ///< of heights, from metres to the space of the puffs
    float voxel_ = 1.0F;    ///< metres
};

}  // namespace

Volume makeCumulus(int resolution, std::uint64_t seed, const Report& report) {
    std::vector<Puff> puffs = growPuffs(seed, kWidth - 2.0F * kMargin);
    const PuffBounds bounds = boundPuffs(puffs);
    const glm::vec3 extent = bounds.high - bounds.low + 2.0F * kMargin;
    Volume volume = makeBox("cumulus", glm::dvec3(extent.x, kHeight, extent.z), resolution);
    const Cumulus cumulus(volume, std::move(puffs), seed);
    fillSlices(volume, report, [&](int z) { cumulus.fillSlice(z); });
    return volume;
}

}  // namespace lumulus::vdb
