#pragma once

#include <functional>

namespace lumulus {

/// Makes Ctrl-C (SIGINT) and SIGTERM set a flag that long work asks for between its steps. The second signal of the
/// same kind ends the process at once. Also ignores SIGXFSZ and SIGPIPE, so that a write that meets the limit of file
/// sizes or a closed pipe fails with an error code instead of killing the process.
void installSignalHandlers();

/// True after the first SIGINT or SIGTERM.
bool interrupted();

/// For the steps of long work, on any thread. Throws Error after the first SIGINT or SIGTERM.
void stopIfInterrupted();

/// What long work asks between its steps: throws where the work is to end.
using Check = std::function<void()>;

}  // namespace lumulus
