#pragma once

#include <openvdb/openvdb.h>

#include <string>

/// OpenVDB files in memory (inside vdb/ only: the header costs seconds).
namespace lumulus::vdb {

/// The bytes of an ordinary .vdb file. Equal grids give equal bytes. Errors: those of OpenVDB.
std::string bytesOf(const openvdb::GridCPtrVec& grids);

}  // namespace lumulus::vdb
