#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "base/interrupt.h"
#include "vdb/quantise.h"
#include "vdb/volume.h"

namespace lumulus::vdb {

/// A field by leaves of 8³ voxels, none of which is needed in memory. Coordinates count in leaves.
struct LeafTable {
    static constexpr int edge = 8;
    static constexpr std::size_t values = 512;
    using Values = std::span<float, values>;

    struct Leaf {
        glm::ivec3 at{0};
        float least = 0.0F, most = 0.0F;  ///< of its values, those that are no densities taken as 0
        float mass = 0.0F;                ///< sum of its values
        std::uint8_t touches = 0;         ///< bits 0 to 2: whether values above 0 touch its lower face across x, y, z
        std::uint64_t source = 0;         ///< what `read` finds it by

        bool isConstant() const { return least == most; }
    };

    std::vector<Leaf> leaves;  ///< those with density; at most one at a place
    /// Gives the values of a leaf that is not constant, x fastest. Called by several threads at once. Errors:
    /// InputError where the file has become unreadable.
    std::function<void(const Leaf&, Values)> read;
};

/// Fills least, most, mass and touches of a leaf from its values.
void measureLeaf(LeafTable::Leaf& leaf, std::span<const float, LeafTable::values> values);

/// The leaves of a dense volume, which must outlive the table.
LeafTable leavesOf(const Volume& volume);

/// What the index of a sparse volume has for each brick, in 8 bytes. The density at texel value t is low + span · t.
struct BrickEntry {
    std::uint32_t place = 0;  ///< level in bits 28 and 29, below it the place of the slot in the pool (slotPlace)
    std::uint32_t range = 0;  ///< low and span as two half floats, low in the lower bits; a constant has a span of 0
};

/// Where a slot lies in the pool, in slots: 9 bits of x, 9 of y, 10 of z.
inline std::uint32_t slotPlace(const glm::uvec3& slot) {
    return slot.x | slot.y << 9U | slot.z << 18U;
}

/// The slot of an entry's place.
inline glm::uvec3 slotOf(std::uint32_t place) {
    return {place & 511U, place >> 9U & 511U, place >> 18U & 1023U};
}

inline int levelOf(const BrickEntry& entry) {
    return static_cast<int>(entry.place >> 28U);
}

/// A density field in bricks of 8³ voxels. A brick with texels has a slot of 9³ of them in a pool, so that
/// interpolation stays within it; a slot of level l holds 2^l bricks along each axis at texels 2^l voxels apart. Empty
/// bricks and constant ones have none. Bricks are found by two levels: a root for each 4³ bricks, and 4³ entries for
/// each root that has any brick. Voxel coordinates are those of vdb::Volume: voxel (i,j,k) has its value at (i+½, j+½,
/// k+½).
struct SparseVolume {
    static constexpr int brickEdge = 8, slotEdge = 9, nodeEdge = 4, nodeEntries = 64, mostLevel = 3;
    static constexpr std::size_t slotTexels = 729;

    /// What a slot holds.
    struct Slot {
        glm::ivec3 brick{0};  ///< its first brick
        int level = 0;
    };

    struct Counts {
        std::uint64_t activeVoxels = 0;  ///< in leaves with density
        std::uint64_t dense = 0;         ///< bricks with texels …
        std::uint64_t constant = 0;      ///< … without, of one value …
        std::uint64_t empty = 0;         ///< … and of the value 0, of the whole box
        std::uint64_t slots[4] = {};     ///< by level
    };

    glm::ivec3 size{0};                ///< voxels, of which the outermost are 0
    glm::ivec3 roots{0};               ///< along each axis
    std::vector<std::uint32_t> nodes;  ///< number of the node of each root, x fastest; 0 is the node of empty bricks
    std::vector<BrickEntry> entries;   ///< 64 for each node, x fastest
    std::vector<std::int32_t> leafOf;  ///< number of the leaf of each entry; −1: none
    std::vector<Slot> slots;
    int cellBricks = 1;                        ///< edge of a majorant cell, in bricks
    std::vector<float> cellMajorants;          ///< of each cell, x fastest, of the maximum: the largest texel that
                                               ///< interpolation within the cell can see; made by fillSlots()
    int poolWidth = 1;                         ///< slots of the pool along x and along y
    std::uint32_t firstSlot = 0;               ///< number in the pool of the first one
    DensityFormat format = DensityFormat::r8;  ///< or r16f
    double relativeError = 0.0;                ///< Σ|q − v| / Σ v of all texels, once they are made
    float maximum = 0.0F;
    Affine toWorld;  ///< voxel coordinates → metres
    std::string name;
    Counts counts;
    LeafTable leaves;

    bool empty() const { return maximum <= 0.0F; }
    glm::ivec3 bricks() const { return (size + brickEdge - 1) / brickEdge; }
    glm::ivec3 cells() const { return (bricks() + cellBricks - 1) / cellBricks; }
    /// Index into `entries` of a brick within the box.
    std::size_t entryOf(const glm::ivec3& brick) const;
    /// The leaf at a brick; null where there is none, and outside of the box.
    const LeafTable::Leaf* leafAt(const glm::ivec3& brick) const;
    /// Where slot `number` of the pool lies in it.
    glm::uvec3 slotAt(std::uint32_t number) const;
    /// Texels of the pool along its axes.
    glm::ivec3 poolSize() const;
    std::uint64_t poolBytes() const;
    std::uint64_t indexBytes() const { return 8 * (nodes.size() + entries.size()); }
    /// Pool, index, the collectors' index, which is as large, and two grids of majorants.
    std::uint64_t gpuBytes() const;
};

/// The level of a cube of voxels: the largest that may stand for it. `minimum` and `edge` are voxels.
using LevelRule = std::function<int(const glm::ivec3& minimum, int edge)>;

/// R8 where the error of storing leaves in it, Σ|q − v| / Σ v over some hundreds of them, is at most 1e-3; else R16F.
DensityFormat chooseFormat(const LeafTable& leaves);

/// Lays out bricks for the leaves: index and slots, no texels yet. `volume` has size, maximum, leaves and format.
/// Without a rule all bricks have level 0. Errors: what `check` throws.
void layOut(SparseVolume& volume, const LevelRule& rule, const Check& check);

/// Gives the slots their places in a pool that is `width` slots wide, from slot number `first` on: several volumes may
/// share one. layOut() gives those of a pool of the volume's own.
void placeSlots(SparseVolume& volume, int width, std::uint32_t first);

/// Width of a pool for so many slots, in slots along x and y.
int poolWidthFor(std::size_t slots);

/// Receives the texels of the volume's slots `first`, …, one slot after the other, x fastest.
using SlotSink = std::function<void(std::uint32_t first, std::span<const std::byte> texels)>;

/// Makes the texels of all slots, in order, region by region, with the region's leaves in memory; the entries'
/// ranges, the majorants and the relative error with them. Errors: those of reading leaves, and what `check` throws.
void fillSlots(SparseVolume& volume, const SlotSink& sink, const Check& check);

/// Texels for all slots in memory, for tests and for small volumes.
std::vector<std::byte> allTexels(SparseVolume& volume, const Check& check = stopIfInterrupted);

/// The interpolated density, of the maximum, at a voxel coordinate, as shaders find it. For tests.
float densityAt(const SparseVolume& volume, std::span<const std::byte> texels, const glm::vec3& voxel);

}  // namespace lumulus::vdb
