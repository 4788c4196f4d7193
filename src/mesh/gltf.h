#pragma once

#include <cstddef>
#include <filesystem>

#include "mesh/model.h"

namespace lumulus::mesh {

/// Triangles of a file at most, all nodes together.
inline constexpr std::size_t mostTriangles = std::size_t{1} << 24U;

/// Reads a glTF 2.0 file (.glb, or .gltf with files beside it or below its folder): the triangles of its default scene,
/// or of all root nodes without one. What its header claims is held against the size of its data before memory is
/// taken. Skins, animations, morph targets and cameras are left out; materials with alpha mode BLEND count as a mask at
/// 0.5, and surfaces are the same on both sides. Errors: InputError, which names the file, for all that is wrong with
/// it: damaged data, files outside of its folder, cycles of nodes, indices and accessors out of range, numbers that are
/// not finite, no triangle, more than mostTriangles, textures that are no PNG or JPEG.
Model loadGltf(const std::filesystem::path& file);

}  // namespace lumulus::mesh
