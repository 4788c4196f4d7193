#pragma once

#include <openvdb/openvdb.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "vdb/choose_grid.h"
#include "vdb/grid_archive.h"
#include "vdb/read_limits.h"

/// Reading an OpenVDB file safely (inside vdb/ only: the header costs seconds).
namespace lumulus::vdb {

/// The grids of an OpenVDB or NanoVDB file. Where the file allows it (GridArchive), they are read one by one.
class GridFile {
  public:
    /// Reads names, types and transforms. `limits` must outlive this. Throws InputError for a missing, damaged or
    /// foreign file and for one that takes more than the limit; Error if interrupted, or what the check throws.
    GridFile(const std::filesystem::path& path, const ReadLimits& limits);
    ~GridFile();

    /// All grids; not all have trees.
    const openvdb::GridPtrVec& grids() const { return grids_; }
    /// A grid with its tree. Errors: as above.
    openvdb::GridBase::Ptr read(std::size_t index);
    /// Whether the values of a grid can be read leaf by leaf.
    bool hasStream(std::size_t index);
    /// Reads a grid without values, and then its values (GridArchive). Errors: as above.
    openvdb::FloatGrid::Ptr readStructure(std::size_t index);
    void streamLeaves(openvdb::FloatGrid& grid, const GridArchive::LeafVisit& visit);
    const openvdb::io::StreamMetadata& storage() const { return archive_->storage(); }
    /// As choosing a grid takes them. They refer to this.
    std::vector<GridLabel> labels();

  private:
    std::filesystem::path path_;
    std::unique_ptr<GridArchive> archive_;  ///< null where all grids are read
    openvdb::GridPtrVec grids_;
};

/// Type of a grid's values: "float", "half" (floats that are saved as half), "double", "vec3s", …
std::string valueType(const openvdb::GridBase& grid);

}  // namespace lumulus::vdb
