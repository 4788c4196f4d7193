#pragma once

#include <string>

namespace CLI {
class App;
}

namespace lumulus::cli {

/// A script for bash that completes commands, options, the values of options that have a list of them, and file names.
std::string bashCompletion(const CLI::App& app);

}  // namespace lumulus::cli
