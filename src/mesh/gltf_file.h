#pragma once

#include <tiny_gltf.h>

#include <filesystem>
#include <string>

namespace lumulus::mesh {

/// Throws what is wrong with a glTF file. `what`: in words, with the place in the file.
[[noreturn]] void failGltf(const std::filesystem::path& file, const std::string& what, const std::string& mend);

/// A file as tinygltf reads it, with the buffers beside it. Pictures are left as the bytes of their files. Errors:
/// those of loadGltf() for files that cannot be read, lie outside of the folder, or are no glTF.
tinygltf::Model readGltf(const std::filesystem::path& file);

}  // namespace lumulus::mesh
