#pragma once

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <openvdb/io/io.h>
#include <openvdb/openvdb.h>

#include <filesystem>
#include <fstream>

#include "vdb/sparse_volume.h"

/// Reading single leaves (inside vdb/ only: the header costs seconds).
namespace lumulus::vdb {

/// The values of a leaf, x fastest; those that are inactive or no densities are 0.
void leafValues(const openvdb::FloatTree::LeafNodeType& leaf, LeafTable::Values values);

/// Reads leaves of a grid by their places in the file, by several threads at once, each through a stream of its own.
class LeafReader {
  public:
    /// `storage` and `asHalf` are those of the file and of the grid (GridArchive).
    LeafReader(std::filesystem::path path, const openvdb::io::StreamMetadata& storage, float background, bool asHalf);

    /// Errors: InputError where the file is not what it was.
    void read(std::uint64_t place, LeafTable::Values values);

  private:
    struct Stream {
        std::ifstream in;
        openvdb::SharedPtr<openvdb::io::StreamMetadata> storage;
    };
    Stream open() const;

    std::filesystem::path path_;
    openvdb::io::StreamMetadata storage_;
    float background_;
    bool half_;
    tbb::enumerable_thread_specific<Stream> streams_;
};

}  // namespace lumulus::vdb
