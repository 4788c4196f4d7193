#pragma once

#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/io/io.h>
#include <openvdb/openvdb.h>

#include <functional>
#include <istream>
#include <vector>

#include "vdb/header.h"
#include "vdb/metered_file.h"

/// Reading single grids of an OpenVDB file (inside vdb/ only: the header costs seconds).
namespace lumulus::vdb {

/// The grids of an OpenVDB file. A file that tells where its grids lie (OpenVDB's io::File writes such) gives them one
/// by one, and the others are skipped; a file that was written as a stream gives all of them at once. openvdb::io::File
/// does as much, but cannot be stopped and takes truncated files for whole ones.
class GridArchive : private openvdb::io::Archive {
  public:
    /// `limits` must outlive this.
    GridArchive(const std::filesystem::path& path, const ReadLimits& limits);

    /// Reads names, types and transforms. To be called first. Errors: those of OpenVDB and of the limits, and
    /// std::ios::failure.
    void readHeads();
    /// All grids; trees are there of those that were read.
    const openvdb::GridPtrVec& grids() const { return grids_; }
    /// Reads the tree of a grid, where it was not read yet. Errors: as above.
    void read(std::size_t index);
    /// Whether the values of a grid can be read leaf by leaf: floats, whose tree was not read yet.
    bool hasStream(std::size_t index);
    /// Reads the structure of such a grid: a tree of leaves without values. Errors: as above.
    openvdb::FloatGrid::Ptr readStructure(std::size_t index);
    /// Visits the leaves of that grid in the order of the file, each with its values and its place in the file. They
    /// are gone afterwards. Errors: as above.
    using LeafVisit = std::function<void(openvdb::FloatTree::LeafNodeType& leaf, std::uint64_t place)>;
    void streamLeaves(openvdb::FloatGrid& grid, const LeafVisit& visit);
    /// How the file's values are stored, for readers of single leaves.
    const openvdb::io::StreamMetadata& storage() const { return *metadata_; }
    /// Whether the file ended too early.
    bool ended() const { return in_.eof(); }
    /// Throws again what ended the reading, where that was not the file.
    void rethrow() const { file_.rethrow(); }

  private:
    void readHead(openvdb::GridBase& grid);
    void readTree(std::size_t index);

    MeteredFile file_;
    openvdb::SharedPtr<openvdb::io::StreamMetadata> metadata_;  // the stream points to it
    std::istream in_;
    HeadCheck check_;
    std::vector<openvdb::io::GridDescriptor> descriptors_;
    openvdb::GridPtrVec grids_;
    std::vector<bool> isRead_;
};

}  // namespace lumulus::vdb
