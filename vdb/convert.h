#pragma once

#include <openvdb/openvdb.h>

#include <string>

#include "vdb/load.h"

/// Making a volume from a grid that is in memory (inside vdb/ only: the header costs seconds).
namespace lumulus::vdb {

/// Makes a volume from a scalar grid and sets its inactive values to 0. `file` stands in messages for the file.
/// Errors: those of load().
LoadResult convert(const openvdb::GridBase::Ptr& grid, const LoadOptions& options, const std::string& file);

}  // namespace lumulus::vdb
