#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "vdb/billowing.h"
#include "vdb/blocks.h"
#include "vdb/bumps.h"
#include "vdb/noise.h"

// Only blocks near the surface are evaluated voxel by voxel. What varies slowly is interpolated between the points of a
// coarser grid.
namespace lumulus::vdb {
namespace {

constexpr float kBend = 20.0F;  ///< metres: the warp moves points by at most ¾ of it along each axis
constexpr int kBlock = 8;       ///< voxels along a block
constexpr int kRegion = 32;     ///< voxels along a region, which lists the spheres near it
constexpr int kOctaves = 5;

/// Sizes of the bumps in metres, each about half of the one before.
constexpr std::array<float, kOctaves> kSizes{54.0F, 27.0F, 13.0F, 6.4F, 3.2F};

struct Seeds {
    std::uint32_t warp, bumps, fray, inside, base;
};

/// What varies slowly: evaluated on a coarse grid and interpolated.
struct Smooth {
    glm::vec3 warp{0.0F};
    float fray = 0.0F;
    float inside = 0.0F;

    friend Smooth operator*(float w, const Smooth& s) { return {w * s.warp, w * s.fray, w * s.inside}; }
    Smooth& operator+=(const Smooth& s) {
        warp += s.warp;
        fray += s.fray;
        inside += s.inside;
        return *this;
    }
};

/// Axes of the grid of each octave, rotated so that no two grids coincide.
glm::mat3 axesOf(int octave) {
    const float a = 0.6F + 1.1F * static_cast<float>(octave), b = 0.9F + 0.7F * static_cast<float>(octave);
    const glm::mat3 about(std::cos(a), 0.0F, -std::sin(a), 0.0F, 1.0F, 0.0F, std::sin(a), 0.0F, std::cos(a));
    const glm::mat3 over(std::cos(b), std::sin(b), 0.0F, -std::sin(b), std::cos(b), 0.0F, 0.0F, 0.0F, 1.0F);
    return over * about;
}

/// What a thread keeps while it fills a block.
struct Workspace {
    std::vector<Puff> region, near;
    std::vector<Smooth> smooth;
    std::array<BumpTable, kOctaves> bumps;
};

class Billowing {
  public:
    Billowing(Volume& volume, std::vector<Puff> puffs, float height, std::uint64_t seed);

    void fillRegion(const Block& region) const;

  private:
    glm::vec3 toPuffs(const glm::vec3& point, const glm::vec3& warp) const {
        return glm::vec3(point.x, point.y * heightFactor_, point.z) + kBend * warp;
    }
    glm::vec3 centreOf(const glm::vec3& voxel) const { return (voxel + 0.5F) * voxel_ + origin_; }
    Smooth smoothAt(const glm::vec3& point) const;
    void fillBlock(const Block& block, Workspace& work) const;
    bool nearPuffs(const Block& block, Workspace& work) const;
    void tabulate(const Block& block, Workspace& work) const;
    Smooth interpolated(const Workspace& work, const glm::ivec3& offset) const;
    float roughened(const glm::vec3& point, const Smooth& smooth, float distance, const Workspace& work) const;
    float density(const glm::vec3& point, const Smooth& smooth, float distance) const;

    Volume& volume_;
    std::vector<Puff> puffs_;
    Seeds seeds_{};
    float height_;               ///< metres
    glm::vec3 origin_{0.0F};     ///< corner of voxel 0, metres
    float heightFactor_ = 1.0F;  ///< of heights, from metres to the space of the puffs
    float voxel_ = 1.0F;         ///< metres
    float edge_ = 1.0F;          ///< metres from clear air to the density inside
    float roughness_ = 0.0F;     ///< metres by which bumps and fray can move the surface, and half of the edge
    float heights_ = 0.0F;       ///< metres, of the bumps of all octaves
    int octaves_ = 1;            ///< whose bumps are larger than voxels
    int stride_ = 1;             ///< voxels between points of the coarse grid
    std::array<glm::mat3, kOctaves> axes_;  ///< from metres to the cells of an octave
};

constexpr float kFray = 15.0F;  ///< metres, of the fray at most
constexpr float kInset = 9.0F;  ///< metres by which the spheres shrink, so that bumps add no mass

/// Height of an octave's bumps in metres.
float heightOf(std::size_t octave) {
    return 0.62F * kSizes[octave];
}

Billowing::Billowing(Volume& volume, std::vector<Puff> puffs, float height, std::uint64_t seed)
    : volume_(volume), puffs_(std::move(puffs)), height_(height) {
    seeds_ = {deriveSeed(seed, 1), deriveSeed(seed, 2), deriveSeed(seed, 3), deriveSeed(seed, 4), deriveSeed(seed, 5)};
    heightFactor_ = boundPuffs(puffs_).high.y / height;
    voxel_ = static_cast<float>(volume.toWorld.linear[0][0]);
    origin_ = glm::vec3(volume.toWorld.translation);
    edge_ = std::max(4.0F, 1.3F * voxel_);
    while (octaves_ < kOctaves && kSizes[static_cast<std::size_t>(octaves_)] > 2.2F * voxel_) ++octaves_;
    while (stride_ < kBlock && 2.0F * static_cast<float>(stride_) * voxel_ < 11.0F) stride_ *= 2;
    roughness_ = 0.5F * edge_ + kFray + kInset;
    for (std::size_t octave = 0; octave < static_cast<std::size_t>(octaves_); ++octave) {
        heights_ += heightOf(octave);
        axes_[octave] = axesOf(static_cast<int>(octave)) / kSizes[octave];
    }
    roughness_ += std::max(BumpTable::mean, 1.0F - BumpTable::mean) * heights_;
}

Smooth Billowing::smoothAt(const glm::vec3& point) const {
    constexpr float size = 90.0F;
    const glm::vec3 q = point / size;
    Smooth smooth;
    smooth.warp = {fractalNoise(q, seeds_.warp, 2), fractalNoise(q, seeds_.warp + 2U, 2),
                   fractalNoise(q, seeds_.warp + 4U, 2)};
    smooth.fray = fractalNoise(point / 44.0F, seeds_.fray, 2);
    smooth.inside = fractalNoise(point / 70.0F, seeds_.inside, 2);
    return smooth;
}

void Billowing::fillRegion(const Block& region) const {
    static thread_local Workspace work;
    const glm::vec3 low = centreOf(glm::vec3(region.first)), high = centreOf(glm::vec3(region.end - 1));
    const glm::vec3 middle = toPuffs(0.5F * (low + high), glm::vec3(0.0F));
    const float reach = roughness_ + 0.75F * std::sqrt(3.0F) * kBend +
                        0.5F * glm::length((high - low) * glm::vec3(1.0F, heightFactor_, 1.0F));
    work.region.clear();
    for (const Puff& puff : puffs_)
        if (glm::length(puff.centre - middle) - puff.radius < reach) work.region.push_back(puff);
    if (work.region.empty()) return;
    const glm::ivec3 along = blocksAlong(region, kBlock);
    for (int i = 0; i < along.x * along.y * along.z; ++i) fillBlock(blockAt(region, kBlock, i), work);
}

/// Lists the spheres that may be the nearest ones of a point of the block. False where none is near enough.
bool Billowing::nearPuffs(const Block& block, Workspace& work) const {
    glm::vec3 low(1e9F), high(-1e9F);
    const int points = kBlock / stride_ + 1;
    std::size_t i = 0;
    for (int z = 0; z < points; ++z)
        for (int y = 0; y < points; ++y)
            for (int x = 0; x < points; ++x) {
                const glm::vec3 voxel = glm::vec3(block.first + stride_ * glm::ivec3(x, y, z));
                const glm::vec3 warped = toPuffs(centreOf(voxel), work.smooth[i++].warp);
                low = glm::min(low, warped);
                high = glm::max(high, warped);
            }
    const glm::vec3 middle = 0.5F * (low + high);
    const float half = 0.5F * glm::length(high - low);
    float nearest = roughness_;  // the largest distance that any point of the block has to the union
    for (const Puff& puff : work.region)
        nearest = std::min(nearest, glm::length(puff.centre - middle) - puff.radius + half);
    work.near.clear();
    for (const Puff& puff : work.region)
        if (glm::length(puff.centre - middle) - puff.radius - half < nearest) work.near.push_back(puff);
    return !work.near.empty();
}

/// Fills the tables of bumps for a block.
void Billowing::tabulate(const Block& block, Workspace& work) const {
    const glm::vec3 low = centreOf(glm::vec3(block.first)), high = centreOf(glm::vec3(block.first + kBlock));
    glm::vec3 lowWarp(1e9F), highWarp(-1e9F);
    for (const Smooth& smooth : work.smooth) {
        lowWarp = glm::min(lowWarp, smooth.warp);
        highWarp = glm::max(highWarp, smooth.warp);
    }
    const glm::vec3 from = low + kBend * lowWarp, to = high + kBend * highWarp;
    for (std::size_t octave = 0; octave < static_cast<std::size_t>(octaves_); ++octave) {
        const glm::vec3 middle = axes_[octave] * (0.5F * (from + to)), half = 0.5F * (to - from);
        const glm::mat3& axes = axes_[octave];
        const glm::vec3 extent = glm::abs(axes[0]) * half.x + glm::abs(axes[1]) * half.y + glm::abs(axes[2]) * half.z;
        work.bumps[octave].cover(middle - extent, middle + extent, seeds_.bumps + static_cast<std::uint32_t>(octave));
    }
}

Smooth Billowing::interpolated(const Workspace& work, const glm::ivec3& offset) const {
    const int points = kBlock / stride_ + 1;
    const glm::ivec3 cell = offset / stride_;
    const glm::vec3 f = glm::vec3(offset - cell * stride_) / static_cast<float>(stride_);
    Smooth sum;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::ivec3 side(corner & 1, (corner >> 1) & 1, corner >> 2);
        const glm::vec3 w = glm::mix(1.0F - f, f, glm::vec3(side));
        const float weight = w.x * w.y * w.z;
        if (weight == 0.0F) continue;
        const glm::ivec3 at = cell + side;
        sum += weight * work.smooth[static_cast<std::size_t>((at.z * points + at.y) * points + at.x)];
    }
    return sum;
}

void Billowing::fillBlock(const Block& block, Workspace& work) const {
    const int points = kBlock / stride_ + 1;
    work.smooth.clear();
    for (int z = 0; z < points; ++z)
        for (int y = 0; y < points; ++y)
            for (int x = 0; x < points; ++x)
                work.smooth.push_back(smoothAt(centreOf(glm::vec3(block.first + stride_ * glm::ivec3(x, y, z)))));
    if (!nearPuffs(block, work)) return;
    bool tabulated = false;
    for (int z = block.first.z; z < block.end.z; ++z)
        for (int y = block.first.y; y < block.end.y; ++y)
            for (int x = block.first.x; x < block.end.x; ++x) {
                const glm::ivec3 voxel(x, y, z);
                const glm::vec3 point = centreOf(glm::vec3(voxel));
                const Smooth smooth = interpolated(work, voxel - block.first);
                const glm::vec3 warped = toPuffs(point, smooth.warp);
                float distance = roughness_;
                for (const Puff& puff : work.near)
                    distance = std::min(distance, glm::length(warped - puff.centre) - puff.radius);
                if (distance >= roughness_) continue;
                if (distance > -roughness_) {
                    if (!std::exchange(tabulated, true)) tabulate(block, work);
                    distance = roughened(point, smooth, distance, work);
                }
                volume_.density[volume_.index(x, y, z)] = density(point, smooth, distance);
            }
}

/// The signed distance with bumps, which stand out where air rises and are hollows where the rim dissolves.
float Billowing::roughened(const glm::vec3& point, const Smooth& smooth, float distance, const Workspace& work) const {
    // the tops grow, the flanks near the base fray
    const float growth = smoothRamp(0.05F, 0.38F, point.y / height_ + 0.25F * smooth.inside);
    const float upright = glm::mix(-0.45F, 1.0F, growth);
    const glm::vec3 bent = point + kBend * smooth.warp;
    distance += kInset + glm::mix(kFray, 3.0F, growth) * smooth.fray;
    float left = heights_ * upright;  // of the bumps that are still to come
    for (std::size_t octave = 0; octave < static_cast<std::size_t>(octaves_); ++octave) {
        const float outwards = (1.0F - BumpTable::mean) * left, inwards = -BumpTable::mean * left;
        const float edge = 0.5F * edge_;
        if (distance - std::max(outwards, inwards) > edge || distance - std::min(outwards, inwards) < -edge) break;
        const float height = upright * heightOf(octave);
        distance -= height * (work.bumps[octave].at(axes_[octave] * bent) - BumpTable::mean);
        left -= height;
    }
    return distance;
}

float Billowing::density(const glm::vec3& point, const Smooth& smooth, float distance) const {
    const float surface = smoothRamp(-0.5F, 0.5F, -distance / edge_);  // centred: the mass does not depend on it
    if (surface <= 0.0F) return 0.0F;
    float base = 1.0F;
    constexpr float highest = 40.0F;
    if (point.y < highest) {
        const float ground = 9.0F + 9.0F * fractalNoise(glm::vec3(point.x, 0.0F, point.z) / 90.0F, seeds_.base, 3);
        base = smoothRamp(ground - 8.0F, ground + 12.0F, point.y);
    }
    // liquid water grows with height above the base, less than adiabatically (Warner 1955)
    const float height = glm::mix(0.55F, 1.0F, std::sqrt(glm::clamp(point.y / (0.62F * height_), 0.0F, 1.0F)));
    const float texture = 0.92F + 0.16F * smooth.inside;
    return glm::clamp(surface * base * height * texture, 0.0F, 1.0F);
}

}  // namespace

void fillBillowing(Volume& volume, std::vector<Puff> puffs, float height, std::uint64_t seed, const Report& report) {
    const Billowing cloud(volume, std::move(puffs), height, seed);
    fillBlocks(volume, kRegion, report, [&](const Block& region) { cloud.fillRegion(region); });
}

}  // namespace lumulus::vdb
