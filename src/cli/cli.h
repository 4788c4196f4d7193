#pragma once

namespace lumulus::cli {

/// The whole program: parses the command line, runs the subcommand, and turns every error into one line on stderr.
/// Returns the exit code: 0 done, 1 failed while running, 2 bad usage or bad input.
int run(int argc, const char* const* argv);

}  // namespace lumulus::cli
