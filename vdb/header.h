#pragma once

#include <filesystem>

namespace lumulus::vdb {

/// Whether all lengths of names and metadata in an OpenVDB file's header stay within the file. OpenVDB itself fills
/// memory for any length that it reads (up to 4 GiB) before it finds out that the file has no such bytes. Only the head
/// of the first grid is checked where the file does not say where its grids end, and nothing in formats before 222
/// (2014).
bool headerLengthsFit(const std::filesystem::path& path);

}  // namespace lumulus::vdb
