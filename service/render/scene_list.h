#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace lumulus::service {

/// Names of the scene files (.toml) that lie in the folder itself, in alphabetical order: those that a client may load.
/// Links that lead elsewhere, hidden files and names that are no UTF-8 are left out. Of many files the first thousand
/// that the system tells are listed, so that the answer stays short. A folder that cannot be read has none.
std::vector<std::string> sceneNames(const std::filesystem::path& folder);

}  // namespace lumulus::service
