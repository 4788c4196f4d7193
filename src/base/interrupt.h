#pragma once

#include <functional>

namespace lumulus {

/// Makes Ctrl-C (SIGINT) and SIGTERM set a flag that long work asks for between its steps. The second signal of the
/// same kind ends the process at once. Also ignores SIGXFSZ and SIGPIPE, so that a write that meets the limit of file
/// sizes or a closed pipe fails with an error code instead of killing the process.
void installSignalHandlers();

/// As the first signal does: for a program that handles signals in another way, when its work is to end.
void interrupt();

/// True after the first SIGINT or SIGTERM, or interrupt().
bool interrupted();

/// For the steps of long work, on any thread. Throws Error where interrupted().
void stopIfInterrupted();

/// What long work asks between its steps: throws where the work is to end.
using Check = std::function<void()>;

}  // namespace lumulus
