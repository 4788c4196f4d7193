#pragma once

#include <filesystem>
#include <string>

namespace CLI {
class App;
}

namespace lumulus::cli {

struct HelpOptions {
    std::string command;          ///< empty: the program
    std::filesystem::path files;  ///< folder to write man pages and the completion of bash to; empty: print the help
};

/// Runs `lumulus help`: prints the help of the program or of a command, or writes man/man1/*.1 and
/// bash-completion/completions/lumulus below a folder, made from that help. Errors: InputError for an unknown command
/// and for a folder that cannot be written to.
void runHelp(const CLI::App& app, const HelpOptions& options);

}  // namespace lumulus::cli
