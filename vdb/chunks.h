#pragma once

/// Safe reading of the chunks of a file that hold the values of a node (inside vdb/ only).
namespace lumulus::vdb {

/// Makes sure that the program contains chunks.cpp, whose functions replace OpenVDB's own. A linker leaves out files
/// that nobody calls.
void guardChunks();

}  // namespace lumulus::vdb
