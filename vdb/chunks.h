#pragma once

/// How OpenVDB reads the chunks of a file that hold the values of a node (inside vdb/ only).
namespace lumulus::vdb {

/// Makes sure that the program holds chunks.cpp, whose functions take the place of OpenVDB's own: a linker leaves out
/// what nobody calls.
void guardChunks();

}  // namespace lumulus::vdb
