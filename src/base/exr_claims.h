#pragma once

#include <filesystem>

namespace lumulus {

/// Refuses an EXR file whose header claims more than the file can hold, before OpenEXR takes memory for it: pixels that
/// would have to be packed closer than the file's compression ever does (16 MiB may always be claimed), tiles or blocks
/// of rows of that kind (64 MiB), more blocks than the file has room to list, longer attributes, or more than 2^28
/// values. Errors: InputError that names the file, also where the header cannot be read.
void checkExrClaims(const std::filesystem::path& path);

}  // namespace lumulus
