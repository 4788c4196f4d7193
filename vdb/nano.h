#pragma once

#include <openvdb/openvdb.h>

#include <filesystem>

#include "vdb/read_limits.h"

/// Reading NanoVDB files (inside vdb/ only: the header costs seconds).
namespace lumulus::vdb {

/// Metadata of a grid that says of which type it was in a NanoVDB file, as "Float8" or "Vec4f".
inline constexpr const char* nanoTypeName = "nanovdb_type";

/// Reads all grids of a NanoVDB file, unpacked (ZIP, Blosc). Float and double grids and the quantised ones of 4, 8, 16
/// and a varying number of bits become float grids with the active values; of all others only names and types are
/// kept, in grids without voxels. Throws InputError for truncated and damaged files and for versions other than 32
/// and for grids that take more than the limit; what the check of the limits throws.
openvdb::GridPtrVec readNanoGrids(const std::filesystem::path& path, const ReadLimits& limits);

}  // namespace lumulus::vdb
