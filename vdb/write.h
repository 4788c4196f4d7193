#pragma once

#include <filesystem>

#include "vdb/deform.h"
#include "vdb/volume.h"

namespace lumulus::vdb {

/// Writes an ordinary .vdb file: one FloatGrid "density", a fog volume whose transform gives metres; zeros are
/// inactive. `load` reads the same volume back. Equal volumes give equal bytes. The file is written beside the name and
/// renamed, so that nothing half-written stays under the name.
/// Throws InputError if the place cannot be written to or the transform cannot be saved, Error if writing fails (disk
/// full).
void write(const Volume& volume, const std::filesystem::path& path);

/// The same with a second grid "vel" of velocities [m/s].
void write(const Volume& volume, const VelocityGrid& velocities, const std::filesystem::path& path);

}  // namespace lumulus::vdb
