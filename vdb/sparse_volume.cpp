#include "vdb/sparse_volume.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "vdb/brick_codes.h"

namespace lumulus::vdb {
namespace {

bool isWithin(const glm::ivec3& at, const glm::ivec3& extent) {
    return glm::all(glm::greaterThanEqual(at, glm::ivec3(0))) && glm::all(glm::lessThan(at, extent));
}

/// The part of a dense volume that is a leaf; zeros beyond its end.
void readDense(const Volume& volume, const glm::ivec3& leaf, LeafTable::Values values) {
    const glm::ivec3 first = LeafTable::edge * leaf;
    std::size_t place = 0;
    for (int z = 0; z < LeafTable::edge; ++z)
        for (int y = 0; y < LeafTable::edge; ++y)
            for (int x = 0; x < LeafTable::edge; ++x) {
                const glm::ivec3 at = first + glm::ivec3(x, y, z);
                values[place++] = isWithin(at, volume.size) ? volume.density[volume.index(at.x, at.y, at.z)] : 0.0F;
            }
}

}  // namespace

void measureLeaf(LeafTable::Leaf& leaf, std::span<const float, LeafTable::values> values) {
    leaf.least = *std::ranges::min_element(values);
    leaf.most = *std::ranges::max_element(values);
    double mass = 0.0;
    for (const float value : values) mass += static_cast<double>(value);
    leaf.mass = static_cast<float>(mass);
    leaf.touches = 0;
    for (int y = 0; y < LeafTable::edge; ++y)
        for (int x = 0; x < LeafTable::edge; ++x) {
            const auto at = [&](int i, int j, int k) { return values[static_cast<std::size_t>((k * 8 + j) * 8 + i)]; };
            if (at(0, x, y) > 0.0F) leaf.touches |= 1U;
            if (at(x, 0, y) > 0.0F) leaf.touches |= 2U;
            if (at(x, y, 0) > 0.0F) leaf.touches |= 4U;
        }
}

LeafTable leavesOf(const Volume& volume) {
    LeafTable table;
    const glm::ivec3 count = (volume.size + LeafTable::edge - 1) / LeafTable::edge;
    float values[LeafTable::values];
    for (int z = 0; z < count.z; ++z)
        for (int y = 0; y < count.y; ++y)
            for (int x = 0; x < count.x; ++x) {
                LeafTable::Leaf leaf;
                leaf.at = {x, y, z};
                readDense(volume, leaf.at, LeafTable::Values(values));
                measureLeaf(leaf, std::span<const float, LeafTable::values>(values));
                if (leaf.most > 0.0F) table.leaves.push_back(leaf);
            }
    table.read = [&volume](const LeafTable::Leaf& leaf, LeafTable::Values to) { readDense(volume, leaf.at, to); };
    return table;
}

std::size_t SparseVolume::entryOf(const glm::ivec3& brick) const {
    const glm::ivec3 root = brick / nodeEdge, within = brick % nodeEdge;
    const auto number =
        static_cast<std::size_t>(root.x) +
        static_cast<std::size_t>(roots.x) *
            (static_cast<std::size_t>(root.y) + static_cast<std::size_t>(roots.y) * static_cast<std::size_t>(root.z));
    return std::size_t{nodeEntries} * nodes[number] +
           static_cast<std::size_t>((within.z * nodeEdge + within.y) * nodeEdge + within.x);
}

const LeafTable::Leaf* SparseVolume::leafAt(const glm::ivec3& brick) const {
    if (!isWithin(brick, bricks())) return nullptr;
    const std::int32_t leaf = leafOf[entryOf(brick)];
    return leaf < 0 ? nullptr : &leaves.leaves[static_cast<std::size_t>(leaf)];
}

glm::uvec3 SparseVolume::slotAt(std::uint32_t number) const {
    const auto width = static_cast<std::uint32_t>(poolWidth);
    return {number % width, number / width % width, number / (width * width)};
}

glm::ivec3 SparseVolume::poolSize() const {
    const std::size_t layer = static_cast<std::size_t>(poolWidth) * static_cast<std::size_t>(poolWidth);
    const std::size_t layers = std::max<std::size_t>((slots.size() + layer - 1) / layer, 1);
    return slotEdge * glm::ivec3(poolWidth, poolWidth, static_cast<int>(layers));
}

std::uint64_t SparseVolume::poolBytes() const {
    const glm::u64vec3 size64(poolSize());
    return size64.x * size64.y * size64.z * texelBytes(format);
}

std::uint64_t SparseVolume::gpuBytes() const {
    const glm::u64vec3 grid(cells());
    return poolBytes() + 2 * indexBytes() + 8 * grid.x * grid.y * grid.z;
}

DensityFormat chooseFormat(const LeafTable& leaves) {
    constexpr std::size_t most = 512;
    constexpr double tolerance = 1e-3;
    const std::size_t step = std::max<std::size_t>(leaves.leaves.size() / most, 1);
    float values[LeafTable::values];
    CodeError error;
    for (std::size_t i = 0; i < leaves.leaves.size(); i += step) {
        const LeafTable::Leaf& leaf = leaves.leaves[i];
        if (leaf.isConstant()) {
            error.values += static_cast<double>(leaf.mass);
            continue;
        }
        leaves.read(leaf, LeafTable::Values(values));
        std::byte codes[LeafTable::values];
        encode(values, DensityFormat::r8, codes, error);
    }
    return error.relative() <= tolerance ? DensityFormat::r8 : DensityFormat::r16f;
}

std::vector<std::byte> allTexels(SparseVolume& volume, const Check& check) {
    std::vector<std::byte> all;
    fillSlots(
        volume,
        [&](std::uint32_t, std::span<const std::byte> part) { all.insert(all.end(), part.begin(), part.end()); },
        check);
    return all;
}

float densityAt(const SparseVolume& volume, std::span<const std::byte> texels, const glm::vec3& voxel) {
    const glm::vec3 centred = glm::clamp(voxel - 0.5F, glm::vec3(0.0F), glm::vec3(volume.size) - 1.0F);
    const glm::ivec3 brick = glm::min(glm::ivec3(centred) / SparseVolume::brickEdge, volume.bricks() - 1);
    const BrickEntry entry = volume.entries[volume.entryOf(brick)];
    const int level = levelOf(entry);
    const glm::ivec3 group = (brick >> level) * (SparseVolume::brickEdge << level);
    const glm::vec3 local = (centred - glm::vec3(group)) / static_cast<float>(1 << level);
    const glm::ivec3 first = glm::min(glm::ivec3(local), glm::ivec3(SparseVolume::brickEdge - 1));
    const glm::vec3 part = local - glm::vec3(first);
    const glm::uvec3 slot = slotOf(entry.place);
    const auto width = static_cast<std::size_t>(volume.poolWidth);
    const std::size_t number = slot.x + width * (slot.y + width * slot.z);
    const CodeRange range = unpackRange(entry.range);
    float sum = 0.0F;
    for (int corner = 0; corner < 8 && range.span > 0.0F; ++corner) {
        const glm::ivec3 step(corner & 1, corner >> 1 & 1, corner >> 2);
        const glm::vec3 weight = glm::mix(1.0F - part, part, glm::vec3(step));
        const glm::ivec3 at = first + step;
        const std::size_t place =
            number * SparseVolume::slotTexels + static_cast<std::size_t>((at.z * 9 + at.y) * 9 + at.x);
        sum += weight.x * weight.y * weight.z * texelValue(texels, place, volume.format);
    }
    return range.low + range.span * sum;
}

}  // namespace lumulus::vdb
