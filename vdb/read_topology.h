#pragma once

#include <openvdb/openvdb.h>

#include <istream>

/// Reading the nodes of a tree without loss (inside vdb/ only: the header costs seconds).
namespace lumulus::vdb {

/// Reads the structure of a grid's tree, as Grid::readTopology() does, from a file in which transforms stand before
/// trees (all since 2013). OpenVDB 10 loses the node below the root, with all that is below it, where reading throws;
/// here it is freed, for grids of numbers and vectors. Errors: what the stream throws.
void readTopology(openvdb::GridBase& grid, std::istream& in);

}  // namespace lumulus::vdb
