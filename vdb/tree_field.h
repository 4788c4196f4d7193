#pragma once

#include <openvdb/openvdb.h>

#include <string>

#include "vdb/sparse_field.h"
#include "vdb/volume.h"

/// From an OpenVDB grid to plain values (inside vdb/ only: the header costs seconds).
namespace lumulus::vdb {

/// Calls `visit(box, value)` for the active tiles of a tree, or of a node of it, in the order of its own iterator. That
/// one counts from the first child of the root with each step: minutes for a small file with many tiles there.
template <typename Node, typename Visit>
void forTiles(const Node& node, const Visit& visit) {
    using Child = typename Node::ChildNodeType;
    auto tile = node.cbeginValueOn();
    auto child = node.cbeginChildOn();
    while (tile || child) {
        if (tile && (!child || tile.getCoord() < child.getCoord())) {
            visit(openvdb::CoordBBox::createCube(tile.getCoord(), static_cast<openvdb::Int32>(Child::DIM)), *tile);
            ++tile;
        } else {
            if constexpr (Child::LEVEL > 0) forTiles(*child, visit);
            ++child;
        }
    }
}

/// Whether a grid holds floats (saved as half or not) or doubles.
bool isScalar(const openvdb::GridBase& grid);

/// Whether any active value of a scalar grid is above 0.
bool hasContent(const openvdb::GridBase& grid);

/// The grid itself if it holds floats, or a copy of a double grid with its values rounded. The grid must be scalar.
openvdb::FloatGrid::Ptr asFloats(const openvdb::GridBase::Ptr& grid);

/// Lists the tree's leaves and active tiles. The leaves' values stay in the tree, where inactive ones become 0: they
/// take no part.
SparseField listBlocks(openvdb::FloatTree& tree);

/// The transform from index coordinates to metres; the grid's transform has to be affine.
Affine indexToMetres(const openvdb::GridBase& grid);

}  // namespace lumulus::vdb
