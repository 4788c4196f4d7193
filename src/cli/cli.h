#pragma once

namespace lumulus::cli {

/// Runs the whole program: parses the command line, runs the subcommand, and prints any error as one line on stderr.
/// Returns the exit code: 0 done, 1 failed while running, 2 bad usage or bad input.
int run(int argc, const char* const* argv);

}  // namespace lumulus::cli
