#pragma once

#include <filesystem>

#include "vdb/volume.h"

namespace lumulus::vdb {

/// Writes an ordinary .vdb file: one FloatGrid "density", a fog volume whose transform gives metres; zeros are
/// inactive. `load` gives the volume back. The same volume gives the same bytes. Written beside and renamed:
/// nothing half-written stays under the name.
/// Throws InputError where the place cannot be written to or the transform cannot be saved, Error where writing fails
/// (disk full).
void write(const Volume& volume, const std::filesystem::path& path);

}  // namespace lumulus::vdb
