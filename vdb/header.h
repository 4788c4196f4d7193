#pragma once

#include <filesystem>

namespace lumulus::vdb {

/// True if all lengths of names and metadata in an OpenVDB file's header stay within the file. OpenVDB itself fills
/// memory for any length that it reads (up to 4 GiB) before it notices that the file is shorter. In a file that does
/// not tell where its grids end only the head of the first grid is checked, and nothing in formats before 222 (2014).
/// openvdb::initialize() has to have been called.
bool headerLengthsFit(const std::filesystem::path& path);

}  // namespace lumulus::vdb
