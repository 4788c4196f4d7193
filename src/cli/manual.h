#pragma once

#include <string>

namespace CLI {
class App;
}

namespace lumulus::cli {

/// The man page of the program (section 1, roff): its commands, its options, its exit codes. Without a date, so that
/// the same program makes the same page.
std::string programManual(const CLI::App& app);

/// The man page of a command, from its help.
std::string commandManual(const CLI::App& app, const CLI::App& command);

}  // namespace lumulus::cli
