#include <unistd.h>

#include <cstdlib>
#include <exception>
#include <string_view>

#include "base/interrupt.h"
#include "base/log.h"
#include "base/threads.h"
#include "cli/cli.h"
#include "cli/threads.h"

namespace {

/// Ends with one line where a library cannot start a thread and throws where nothing can catch it.
[[noreturn]] void onTerminate() {
    try {
        if (const std::exception_ptr failure = std::current_exception()) std::rethrow_exception(failure);
    } catch (const std::exception& e) {
        lumulus::logError(lumulus::cli::unforeseen(e));
        if (lumulus::cli::isThreadRefused(e)) std::_Exit(1);
    } catch (...) {
        lumulus::logError("an unknown failure: this should not happen, please report it");
    }
    std::abort();
}

#ifndef __SANITIZE_ADDRESS__  // its runtime is not there yet so early

/// Libraries start threads before main(): log4cplus, of OpenVDB, a pool of four. Where there are none they end the
/// process by a signal.
void requireFirstThreads(int, char**, char**) {
    constexpr int first = 4;
    if (lumulus::startableThreads(first) == first) return;
    constexpr std::string_view line =
        "lumulus: error: the system lets this process start too few threads (ulimit -u, pids.max of the cgroup): raise "
        "the limit\n";
    static_cast<void>(::write(STDERR_FILENO, line.data(), line.size()) == 0);
    ::_exit(1);
}

/// Called before anything in the libraries (System V ABI, DT_PREINIT_ARRAY).
[[gnu::section(".preinit_array"), gnu::used]] void (*beforeLibraries)(int, char**, char**) = requireFirstThreads;

#endif

}  // namespace

int main(int argc, char** argv) {
    std::set_terminate(onTerminate);
    lumulus::installSignalHandlers();
    return lumulus::cli::run(argc, argv);
}
