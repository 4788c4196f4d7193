#pragma once

#include <tiny_gltf.h>

#include <filesystem>

#include "mesh/model.h"

namespace lumulus::mesh {

/// Adds the materials of a file, with the textures that they use, and behind them the one of triangles without a
/// material. Errors: InputError, as loadGltf().
void addMaterials(const std::filesystem::path& file, const tinygltf::Model& gltf, Model& model);

}  // namespace lumulus::mesh
