#include <algorithm>
#include <cmath>

#include "vdb/brick_codes.h"
#include "vdb/brick_order.h"
#include "vdb/sparse_volume.h"

namespace lumulus::vdb {
namespace {

/// Cells of the grid of majorants: 16 MiB of floats.
constexpr std::uint64_t mostCells = std::uint64_t{1} << 22U;

std::uint64_t countOf(const glm::ivec3& extent) {
    return static_cast<std::uint64_t>(extent.x) * static_cast<std::uint64_t>(extent.y) *
           static_cast<std::uint64_t>(extent.z);
}

class Layout {
  public:
    Layout(SparseVolume& volume, const LevelRule& rule, const Check& check)
        : volume_(volume), rule_(rule), check_(check), order_(volume.bricks()) {}

    void run() {
        clear();
        enterLeaves();
        listBricks();
        for (std::size_t first = 0; first < keys_.size();) {
            if ((first & 0xFFFU) == 0) check_();
            first = layGroup(first, SparseVolume::mostLevel);
        }
        finish();
    }

  private:
    void clear();
    void enterLeaves();
    void listBricks();
    std::size_t layGroup(std::size_t first, int level);
    void layBrick(const glm::ivec3& brick);
    void addSlot(const glm::ivec3& brick, int level);
    void finish();

    std::size_t nodeFor(const glm::ivec3& brick);
    bool isConstant(const glm::ivec3& brick, float& value) const;
    bool isCoarse(const glm::ivec3& brick) const {
        return rule_ && rule_(SparseVolume::brickEdge * brick, SparseVolume::brickEdge) > 0;
    }

    SparseVolume& volume_;
    const LevelRule& rule_;
    const Check& check_;
    BrickOrder order_;
    std::vector<std::uint64_t> keys_;  ///< of the bricks that are not empty, in order
};

void Layout::clear() {
    volume_.roots = (volume_.bricks() + SparseVolume::nodeEdge - 1) / SparseVolume::nodeEdge;
    volume_.nodes.assign(countOf(volume_.roots), 0);
    volume_.entries.assign(SparseVolume::nodeEntries, {});
    volume_.leafOf.assign(SparseVolume::nodeEntries, -1);
    volume_.slots.clear();
    volume_.counts = {};
    volume_.cellBricks = 1;
    while (countOf(volume_.cells()) > mostCells) volume_.cellBricks *= 2;
}

/// The entry of a brick, in a node of its own if there is none yet.
std::size_t Layout::nodeFor(const glm::ivec3& brick) {
    const std::size_t entry = volume_.entryOf(brick);
    if (entry >= SparseVolume::nodeEntries) return entry;
    const glm::ivec3 root = brick / SparseVolume::nodeEdge;
    const auto number = static_cast<std::size_t>(root.x) +
                        static_cast<std::size_t>(volume_.roots.x) *
                            (static_cast<std::size_t>(root.y) +
                             static_cast<std::size_t>(volume_.roots.y) * static_cast<std::size_t>(root.z));
    volume_.nodes[number] = static_cast<std::uint32_t>(volume_.entries.size() / SparseVolume::nodeEntries);
    volume_.entries.resize(volume_.entries.size() + SparseVolume::nodeEntries);
    volume_.leafOf.resize(volume_.entries.size(), -1);
    return volume_.entryOf(brick);
}

void Layout::enterLeaves() {
    std::ranges::sort(volume_.leaves.leaves, {}, [&](const LeafTable::Leaf& leaf) { return order_.keyOf(leaf.at); });
    for (std::size_t i = 0; i < volume_.leaves.leaves.size(); ++i)
        volume_.leafOf[nodeFor(volume_.leaves.leaves[i].at)] = static_cast<std::int32_t>(i);
}

/// Bricks that interpolation may find something in: those of leaves and, where a leaf touches its lower faces, those
/// below it; all around leaves that have a coarse level, whose texels reach farther.
void Layout::listBricks() {
    const glm::ivec3 bricks = volume_.bricks();
    const auto add = [&](const glm::ivec3& brick) {
        if (glm::all(glm::greaterThanEqual(brick, glm::ivec3(0))) && glm::all(glm::lessThan(brick, bricks)))
            keys_.push_back(order_.keyOf(brick));
    };
    for (const LeafTable::Leaf& leaf : volume_.leaves.leaves) {
        volume_.counts.activeVoxels += LeafTable::values;
        if (isCoarse(leaf.at)) {
            for (int i = 0; i < 27; ++i) add(leaf.at + glm::ivec3(i % 3, i / 3 % 3, i / 9) - 1);
            continue;
        }
        for (unsigned below = 0; below < 8; ++below)
            if ((below & ~leaf.touches) == 0) add(leaf.at - glm::ivec3(below & 1U, below >> 1U & 1U, below >> 2U));
    }
    std::ranges::sort(keys_);
    keys_.erase(std::unique(keys_.begin(), keys_.end()), keys_.end());  // clang 14 cannot compile that of ranges
}

/// Lays the bricks from `first` on that lie in the same cube of 2^level bricks along each axis. Returns the first brick
/// beyond.
std::size_t Layout::layGroup(std::size_t first, int level) {
    const unsigned shift = 3U * static_cast<unsigned>(level);
    const std::uint64_t group = keys_[first] >> shift;
    const glm::ivec3 corner = (order_.brickOf(keys_[first]) >> level) << level;
    if (level == 0) {
        layBrick(corner);
        return first + 1;
    }
    const int edge = SparseVolume::brickEdge << level;
    if (rule_ && rule_(SparseVolume::brickEdge * corner, edge) >= level) {
        addSlot(corner, level);
        while (first < keys_.size() && keys_[first] >> shift == group) ++first;
        return first;
    }
    if (!rule_) return layGroup(first, 0);
    while (first < keys_.size() && keys_[first] >> shift == group) first = layGroup(first, level - 1);
    return first;
}

bool Layout::isConstant(const glm::ivec3& brick, float& value) const {
    const LeafTable::Leaf* own = volume_.leafAt(brick);
    if (own == nullptr || !own->isConstant()) return false;
    value = own->most;
    for (int i = 1; i < 8; ++i) {
        const LeafTable::Leaf* other = volume_.leafAt(brick + glm::ivec3(i & 1, i >> 1 & 1, i >> 2));
        if (other == nullptr || !other->isConstant() || other->most != value) return false;
    }
    return true;
}

void Layout::layBrick(const glm::ivec3& brick) {
    float value = 0.0F;
    if (!isConstant(brick, value)) {
        addSlot(brick, 0);
        return;
    }
    volume_.entries[nodeFor(brick)] = {0, packRange({value / volume_.maximum, 0.0F})};
    ++volume_.counts.constant;
}

/// Gives a cube of bricks a slot. Its place in the pool is known once there are all.
void Layout::addSlot(const glm::ivec3& brick, int level) {
    const auto number = static_cast<std::uint32_t>(volume_.slots.size());
    volume_.slots.push_back({brick, level});
    ++volume_.counts.slots[level];
    const glm::ivec3 end = glm::min(brick + (1 << level), volume_.bricks());
    for (int z = brick.z; z < end.z; ++z)
        for (int y = brick.y; y < end.y; ++y)
            for (int x = brick.x; x < end.x; ++x) {
                // a span above 0 tells apart bricks with texels
                volume_.entries[nodeFor({x, y, z})] = {number, packRange({0.0F, 1.0F})};
                ++volume_.counts.dense;
            }
}

void Layout::finish() {
    volume_.counts.empty = countOf(volume_.bricks()) - volume_.counts.dense - volume_.counts.constant;
    placeSlots(volume_, poolWidthFor(volume_.slots.size()), 0);
}

}  // namespace

int poolWidthFor(std::size_t slots) {
    int width = 1;
    while (std::pow(width, 3) < static_cast<double>(slots)) ++width;
    return width;
}

void placeSlots(SparseVolume& volume, int width, std::uint32_t first) {
    volume.poolWidth = width;
    volume.firstSlot = first;
    for (std::uint32_t number = 0; number < volume.slots.size(); ++number) {
        const SparseVolume::Slot& slot = volume.slots[number];
        const std::uint32_t place = slotPlace(volume.slotAt(first + number)) | static_cast<std::uint32_t>(slot.level)
                                                                                   << 28U;
        const glm::ivec3 end = glm::min(slot.brick + (1 << slot.level), volume.bricks());
        for (int z = slot.brick.z; z < end.z; ++z)
            for (int y = slot.brick.y; y < end.y; ++y)
                for (int x = slot.brick.x; x < end.x; ++x) volume.entries[volume.entryOf({x, y, z})].place = place;
    }
}

void layOut(SparseVolume& volume, const LevelRule& rule, const Check& check) {
    Layout(volume, rule, check).run();
}

}  // namespace lumulus::vdb
