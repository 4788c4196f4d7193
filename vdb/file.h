#pragma once

#include <openvdb/openvdb.h>

#include <filesystem>

/// Reading an OpenVDB file safely (inside vdb/ only: the header costs seconds).
namespace lumulus::vdb {

/// All grids of a file, their values in memory. Throws InputError for whatever is wrong with the file, Error
/// where interrupted.
openvdb::GridPtrVec readGrids(const std::filesystem::path& path);

/// "float", "half", "double", "vec3s", … ("half": floats that are saved as half).
std::string valueType(const openvdb::GridBase& grid);

}  // namespace lumulus::vdb
