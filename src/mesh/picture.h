#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "mesh/model.h"

namespace lumulus::mesh {

/// Pixels of all textures of a file at most.
inline constexpr std::size_t mostTexels = std::size_t{1} << 27U;

/// Decodes a PNG or JPEG. `name`: of the picture in messages. Errors: InputError, as loadGltf(), for bytes that are
/// neither, are damaged, or claim no pixel or more than 2^26.
Texture decodePicture(const std::filesystem::path& file, const std::string& name, std::span<const unsigned char> bytes);

}  // namespace lumulus::mesh
