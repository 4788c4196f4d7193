#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <thread>

#include "vdb/brick_codes.h"
#include "vdb/brick_order.h"
#include "vdb/sparse_volume.h"

namespace lumulus::vdb {
namespace {

constexpr int edge = SparseVolume::brickEdge, slotEdge = SparseVolume::slotEdge;

/// The leaves of a region and of the bricks around it, in memory.
class RegionValues {
  public:
    static constexpr int across = BrickOrder::regionEdge + 2;

    /// `slots`: what the region has.
    RegionValues(const SparseVolume& volume, const glm::ivec3& region, std::span<const SparseVolume::Slot> slots)
        : volume_(volume), first_(BrickOrder::regionEdge * region - 1), places_(across * across * across, absent) {
        for (const SparseVolume::Slot& slot : slots) {
            const glm::ivec3 low = slot.brick - (slot.level > 0 ? 1 : 0), high = slot.brick + (1 << slot.level);
            for (int z = low.z; z <= high.z; ++z)
                for (int y = low.y; y <= high.y; ++y)
                    for (int x = low.x; x <= high.x; ++x) load({x, y, z});
        }
    }

    /// The 8³ values of a brick, x fastest; null where all are 0.
    const float* brick(const glm::ivec3& at) const {
        const std::int32_t place = places_[placeOf(at)];
        return place < 0 ? nullptr : &values_[LeafTable::values * static_cast<std::size_t>(place)];
    }

    float valueAt(const glm::ivec3& voxel) const {
        const float* values = brick(voxel >> 3);
        const glm::ivec3 within = voxel & 7;
        return values == nullptr ? 0.0F : values[(within.z * edge + within.y) * edge + within.x];
    }

  private:
    static constexpr std::int32_t absent = -2, empty = -1;

    std::size_t placeOf(const glm::ivec3& at) const {
        const glm::ivec3 local = at - first_;
        return static_cast<std::size_t>((local.z * across + local.y) * across + local.x);
    }

    void load(const glm::ivec3& at) {
        std::int32_t& place = places_[placeOf(at)];
        if (place != absent) return;
        place = empty;
        const LeafTable::Leaf* leaf = volume_.leafAt(at);
        if (leaf == nullptr) return;
        place = static_cast<std::int32_t>(values_.size() / LeafTable::values);
        values_.resize(values_.size() + LeafTable::values, leaf->most);
        const LeafTable::Values values(values_.end() - LeafTable::values, LeafTable::values);
        if (!leaf->isConstant()) volume_.leaves.read(*leaf, values);
        for (float& value : values) value /= volume_.maximum;
    }

    const SparseVolume& volume_;
    glm::ivec3 first_;
    std::vector<std::int32_t> places_;
    std::vector<float> values_;
};

/// The 9³ values of a slot of level 0.
void fineTexels(const RegionValues& region, const glm::ivec3& brick, std::span<float> texels) {
    const float* parts[8];
    for (int i = 0; i < 8; ++i) parts[i] = region.brick(brick + glm::ivec3(i & 1, i >> 1 & 1, i >> 2));
    float* to = texels.data();
    for (int z = 0; z < slotEdge; ++z)
        for (int y = 0; y < slotEdge; ++y) {
            const int part = (y >> 3) * 2 + (z >> 3) * 4, row = ((z & 7) * edge + (y & 7)) * edge;
            const float* low = parts[part];
            const float* high = parts[part + 1];
            to = low == nullptr ? std::fill_n(to, edge, 0.0F) : std::copy_n(low + row, edge, to);
            *to++ = high == nullptr ? 0.0F : high[row];
        }
}

/// Weighted means along the first axis of a box: a tent, `step` voxels to both sides of every step-th voxel. The axis
/// becomes the last one.
std::vector<float> tentAlong(const std::vector<float>& values, int length, int step) {
    const auto rows = static_cast<int>(values.size()) / length;
    std::vector<float> means(static_cast<std::size_t>(rows * slotEdge));
    const float scale = 1.0F / static_cast<float>(step * step);
    for (int row = 0; row < rows; ++row)
        for (int t = 0; t < slotEdge; ++t) {
            float sum = 0.0F;
            for (int k = 1 - step; k < step; ++k)
                sum += static_cast<float>(step - std::abs(k)) *
                       values[static_cast<std::size_t>(row * length + t * step + step - 1 + k)];
            means[static_cast<std::size_t>(t * rows + row)] = scale * sum;
        }
    return means;
}

/// The 9³ values of a slot of a coarse level: each the mean of the voxels around its place, those nearer counting more,
/// so that the mass of all texels is that of the voxels.
void coarseTexels(const RegionValues& region, const SparseVolume::Slot& slot, std::span<float> texels) {
    const int step = 1 << slot.level, length = (slotEdge - 1) * step + 2 * step - 1;
    const glm::ivec3 first = edge * slot.brick - (step - 1);
    std::vector<float> values;
    values.reserve(static_cast<std::size_t>(length * length * length));
    for (int z = 0; z < length; ++z)
        for (int y = 0; y < length; ++y)
            for (int x = 0; x < length; ++x) values.push_back(region.valueAt(first + glm::ivec3(x, y, z)));
    for (int axis = 0; axis < 3; ++axis) values = tentAlong(values, length, step);
    std::ranges::copy(values, texels.begin());
}

/// For each mask of axes the largest texel that a brick's interpolation sees, on the masked axes within the last half
/// voxel only, which reaches into the next brick's voxels.
using Largest = std::array<float, 8>;

Largest largestOf(const SparseVolume::Slot& slot, const glm::ivec3& brick, std::span<const float> stored) {
    Largest largest{};
    const int texels = std::max(edge >> slot.level, 1);
    const glm::ivec3 low = ((brick - slot.brick) * edge) >> slot.level, high = low + texels;
    for (int z = low.z; z <= high.z; ++z)
        for (int y = low.y; y <= high.y; ++y)
            for (int x = low.x; x <= high.x; ++x) {
                const float value = stored[static_cast<std::size_t>((z * slotEdge + y) * slotEdge + x)];
                const unsigned last =
                    (x >= high.x - 1 ? 1U : 0U) | (y >= high.y - 1 ? 2U : 0U) | (z >= high.z - 1 ? 4U : 0U);
                for (unsigned mask = 0; mask < 8; ++mask)
                    if ((mask & ~last) == 0) largest[mask] = std::max(largest[mask], value);
            }
    return largest;
}

/// What a region gives.
struct Filled {
    std::vector<std::byte> texels;
    std::vector<std::uint32_t> ranges;  ///< of each slot
    std::vector<Largest> largest;       ///< of each brick of each slot, x fastest
    CodeError error;
};

class Filler {
  public:
    Filler(SparseVolume& volume, const SlotSink& sink, const Check& check)
        : volume_(volume), sink_(sink), check_(check) {}

    void run() {
        const glm::u64vec3 cells(volume_.cells());
        volume_.cellMajorants.assign(cells.x * cells.y * cells.z, 0.0F);
        enterConstants();
        CodeError error;
        const std::vector<Part> parts = regions();
        const std::size_t together = std::clamp<std::size_t>(std::thread::hardware_concurrency(), 1, 8);
        for (std::size_t first = 0; first < parts.size(); first += together) {
            std::vector<Filled> filled(std::min(together, parts.size() - first));
            tbb::parallel_for(std::size_t{0}, filled.size(), [&](std::size_t i) {
                check_();
                filled[i] = fill(parts[first + i]);
            });
            for (std::size_t i = 0; i < filled.size(); ++i) {
                enter(parts[first + i], filled[i]);
                error.values += filled[i].error.values;
                error.errors += filled[i].error.errors;
                sink_(static_cast<std::uint32_t>(parts[first + i].first), filled[i].texels);
            }
        }
        volume_.relativeError = error.relative();
    }

  private:
    /// Slots of one region.
    struct Part {
        std::size_t first = 0, count = 0;
        glm::ivec3 region{0};
    };

    std::vector<Part> regions() const {
        std::vector<Part> parts;
        for (std::size_t i = 0; i < volume_.slots.size(); ++i) {
            const glm::ivec3 region = volume_.slots[i].brick / BrickOrder::regionEdge;
            if (parts.empty() || parts.back().region != region) parts.push_back({i, 0, region});
            ++parts.back().count;
        }
        return parts;
    }

    Filled fill(const Part& part) const {
        const std::span<const SparseVolume::Slot> slots(&volume_.slots[part.first], part.count);
        const RegionValues region(volume_, part.region, slots);
        const std::size_t bytes = SparseVolume::slotTexels * texelBytes(volume_.format);
        Filled filled;
        filled.texels.resize(bytes * slots.size());
        std::vector<float> texels(SparseVolume::slotTexels);
        for (std::size_t i = 0; i < slots.size(); ++i) {
            const SparseVolume::Slot& slot = slots[i];
            if (slot.level == 0)
                fineTexels(region, slot.brick, texels);
            else
                coarseTexels(region, slot, texels);
            const std::span<std::byte> codes = std::span(filled.texels).subspan(bytes * i, bytes);
            const CodeRange range = encode(texels, volume_.format, codes, filled.error);
            filled.ranges.push_back(packRange(range));
            for (std::size_t place = 0; place < texels.size(); ++place)
                texels[place] = range.low + range.span * texelValue(codes, place, volume_.format);
            forBricks(slot, [&](const glm::ivec3& brick) { filled.largest.push_back(largestOf(slot, brick, texels)); });
        }
        return filled;
    }

    template <typename Visit>
    void forBricks(const SparseVolume::Slot& slot, const Visit& visit) const {
        const glm::ivec3 end = glm::min(slot.brick + (1 << slot.level), volume_.bricks());
        for (int z = slot.brick.z; z < end.z; ++z)
            for (int y = slot.brick.y; y < end.y; ++y)
                for (int x = slot.brick.x; x < end.x; ++x) visit(glm::ivec3(x, y, z));
    }

    void enter(const Part& part, const Filled& filled) {
        std::size_t place = 0;
        for (std::size_t i = 0; i < part.count; ++i)
            forBricks(volume_.slots[part.first + i], [&](const glm::ivec3& brick) {
                volume_.entries[volume_.entryOf(brick)].range = filled.ranges[i];
                enterMajorants(brick, filled.largest[place++]);
            });
    }

    void enterMajorants(const glm::ivec3& brick, const Largest& largest) {
        const glm::ivec3 bricks = volume_.bricks(), cells = volume_.cells();
        for (int mask = 0; mask < 8; ++mask) {
            const glm::ivec3 at = brick + glm::ivec3(mask & 1, mask >> 1 & 1, mask >> 2);
            if (glm::any(glm::greaterThanEqual(at, bricks))) continue;
            const glm::ivec3 cell = at / volume_.cellBricks;
            float& majorant =
                volume_.cellMajorants[static_cast<std::size_t>(cell.x) +
                                      static_cast<std::size_t>(cells.x) *
                                          (static_cast<std::size_t>(cell.y) +
                                           static_cast<std::size_t>(cells.y) * static_cast<std::size_t>(cell.z))];
            majorant = std::max(majorant, largest[static_cast<std::size_t>(mask)]);
        }
    }

    void enterConstants() {
        for (const LeafTable::Leaf& leaf : volume_.leaves.leaves) {
            if (!leaf.isConstant()) continue;
            const CodeRange range = unpackRange(volume_.entries[volume_.entryOf(leaf.at)].range);
            if (range.span > 0.0F) continue;
            Largest same;
            same.fill(range.low);
            enterMajorants(leaf.at, same);
        }
    }

    SparseVolume& volume_;
    const SlotSink& sink_;
    const Check& check_;
};

}  // namespace

void fillSlots(SparseVolume& volume, const SlotSink& sink, const Check& check) {
    Filler(volume, sink, check).run();
}

}  // namespace lumulus::vdb
