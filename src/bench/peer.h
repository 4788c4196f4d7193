#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "bench/record.h"

namespace lumulus::bench {

/// Rows of another renderer from a table with the columns of error.csv, each row's method "Cycles"
/// (scripts/study/run cycles makes it). Errors: InputError that names the file and line.
std::vector<Row> readPeer(const std::filesystem::path& path);

/// Reads such rows from text; `source` stands for the file in messages.
std::vector<Row> parsePeer(std::string_view text, const std::string& source);

}  // namespace lumulus::bench
