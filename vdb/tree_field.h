#pragma once

#include <openvdb/openvdb.h>

#include <string>

#include "vdb/sparse_field.h"
#include "vdb/volume.h"

/// From an OpenVDB grid to plain values (inside vdb/ only: the header costs seconds).
namespace lumulus::vdb {

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
