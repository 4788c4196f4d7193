#pragma once

#include <functional>

namespace lumulus {

/// Makes Ctrl-C (SIGINT) and SIGTERM set a flag that long work checks between its steps. The second signal of the
/// same kind ends the process at once. Also ignores SIGXFSZ and SIGPIPE, so that a write that meets the limit of file
/// sizes or a closed pipe fails with an error code instead of killing the process.
void installSignalHandlers();

/// Sets the flag as the first signal does, for programs that handle signals in another way.
void interrupt();

/// True after the first SIGINT or SIGTERM, or interrupt().
bool interrupted();

/// Throws Error if interrupted() is true. Long work calls this between its steps, on any thread.
void stopIfInterrupted();

/// A function that long work calls between its steps. It throws when the work has to end.
using Check = std::function<void()>;

}  // namespace lumulus
