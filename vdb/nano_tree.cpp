#include "vdb/nano_tree.h"

#include <algorithm>
#include <type_traits>

#include "base/interrupt.h"

namespace lumulus::vdb {
namespace {

using openvdb::Coord;

/// Goes through a tree whose values are stored as `Build`. Every offset is checked, since it comes from a file.
template <typename Build>
class Walk {
    using Leaf = typename nanovdb::NanoLeaf<Build>::DataType;
    using Lower = typename nanovdb::NanoLower<Build>::DataType;
    using Upper = typename nanovdb::NanoUpper<Build>::DataType;
    using Root = typename nanovdb::NanoRoot<Build>::DataType;
    static constexpr int leafEdge = 8, lowerEdge = 128;  // voxels
    static constexpr int lowerBits = 4, upperBits = 5;   // of the number of children along an edge

  public:
    Walk(const NanoBytes& bytes, const Check& check) : bytes_(bytes), check_(check) {}

    openvdb::FloatTree::Ptr run() {
        constexpr std::int64_t treeAt = sizeof(nanovdb::GridData);
        const auto* tree = bytes_.node<nanovdb::TreeData<3>>(0, treeAt);
        const auto* root = bytes_.node<Root>(treeAt, static_cast<std::int64_t>(tree->mNodeOffset[3]));
        const std::int64_t rootAt = bytes_.positionOf(root);
        spend(sizeof(Root) + sizeof(typename Root::Tile) * root->mTableSize);
        bytes_.node<Root>(rootAt, 0, sizeof(Root) + sizeof(typename Root::Tile) * root->mTableSize);
        tree_ = std::make_shared<openvdb::FloatTree>(static_cast<float>(root->mBackground));
        for (std::uint32_t i = 0; i < root->mTableSize; ++i) {
            const auto& tile = *root->tile(i);
            constexpr int edge = 4096;
            const auto at = tile.origin();
            const Coord origin(at[0] & ~(edge - 1), at[1] & ~(edge - 1), at[2] & ~(edge - 1));
            if (tile.isChild())
                goThrough<upperBits, lowerEdge>(*bytes_.node<Upper>(rootAt, tile.child), origin, 2);
            else if (tile.state != 0)
                tree_->addTile(3, origin, static_cast<float>(tile.value), true);
        }
        return tree_;
    }

  private:
    /// Counts the bytes of a node that is visited: a tree without shared nodes has no more than all.
    void spend(std::size_t bytes) {
        if (bytes > bytes_.size() - spent_) throw DamagedGrid("nodes are shared");
        spent_ += bytes;
    }

    template <int bits, int childEdge, typename Node>
    void goThrough(const Node& node, const Coord& origin, openvdb::Index level) {
        check_();
        spend(sizeof(Node));
        constexpr std::uint32_t children = 1U << (3 * bits), mask = (1U << bits) - 1;
        const std::int64_t here = bytes_.positionOf(&node);
        for (std::uint32_t n = 0; n < children; ++n) {
            const Coord at = origin.offsetBy(static_cast<int>(n >> (2 * bits)) * childEdge,
                                             static_cast<int>((n >> bits) & mask) * childEdge,
                                             static_cast<int>(n & mask) * childEdge);
            if (node.mChildMask.isOn(n)) {
                if constexpr (childEdge == leafEdge)
                    addLeaf(*bytes_.node<Leaf>(here, node.mTable[n].child), at);
                else
                    goThrough<lowerBits, leafEdge>(*bytes_.node<Lower>(here, node.mTable[n].child), at, level - 1);
            } else if (node.mValueMask.isOn(n)) {
                tree_->addTile(level, at, static_cast<float>(node.mTable[n].value), true);
            }
        }
    }

    /// Bytes of a leaf with what follows it.
    static std::size_t bytesOf(const Leaf& leaf) {
        if constexpr (std::is_same_v<Build, nanovdb::FpN>) {
            constexpr int mostBits = 4;  // a value has 2 to this power of bits at most
            return sizeof(Leaf) + (std::size_t{64} << std::min(leaf.mFlags >> 5, mostBits));
        } else {
            return sizeof(Leaf);
        }
    }

    void addLeaf(const Leaf& leaf, const Coord& at) {
        bytes_.node<Leaf>(bytes_.positionOf(&leaf), 0, bytesOf(leaf));
        spend(bytesOf(leaf));
        constexpr std::uint32_t voxels = leafEdge * leafEdge * leafEdge;
        auto& to = *tree_->touchLeaf(at);
        for (std::uint32_t i = 0; i < voxels; ++i)
            if (leaf.mValueMask.isOn(i)) to.setValueOn(i, static_cast<float>(leaf.getValue(i)));
    }

    const NanoBytes& bytes_;
    const Check& check_;
    std::size_t spent_ = 0;
    openvdb::FloatTree::Ptr tree_;
};

}  // namespace

openvdb::FloatTree::Ptr nanoTree(const NanoBytes& bytes, const Check& check) {
    switch (nanoHead(bytes).mGridType) {
        case nanovdb::GridType::Float:
            return Walk<float>(bytes, check).run();
        case nanovdb::GridType::Double:
            return Walk<double>(bytes, check).run();
        case nanovdb::GridType::Fp4:
            return Walk<nanovdb::Fp4>(bytes, check).run();
        case nanovdb::GridType::Fp8:
            return Walk<nanovdb::Fp8>(bytes, check).run();
        case nanovdb::GridType::Fp16:
            return Walk<nanovdb::Fp16>(bytes, check).run();
        case nanovdb::GridType::FpN:
            return Walk<nanovdb::FpN>(bytes, check).run();
        default:
            throw std::invalid_argument("not a grid of scalars");
    }
}

}  // namespace lumulus::vdb
