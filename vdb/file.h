#pragma once

#include <openvdb/openvdb.h>

#include <filesystem>

/// Reading an OpenVDB file safely (inside vdb/ only: the header costs seconds).
namespace lumulus::vdb {

/// Reads all grids of an OpenVDB or NanoVDB file with their values. Throws InputError for a missing, damaged or foreign
/// file, Error if interrupted.
openvdb::GridPtrVec readGrids(const std::filesystem::path& path);

/// Type of a grid's values: "float", "half" (floats that are saved as half), "double", "vec3s", …
std::string valueType(const openvdb::GridBase& grid);

}  // namespace lumulus::vdb
