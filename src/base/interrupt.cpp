#include "base/interrupt.h"

#include <csignal>

#include "base/error.h"

namespace lumulus {
namespace {

// a signal handler reaches nothing but static storage
volatile std::sig_atomic_t interruptFlag = 0;

extern "C" void onInterrupt(int) {
    interruptFlag = 1;
}

}  // namespace

void installSignalHandlers() {
    struct sigaction action {};
    action.sa_handler = onInterrupt;
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    std::signal(SIGXFSZ, SIG_IGN);
    std::signal(SIGPIPE, SIG_IGN);
}

void interrupt() {
    interruptFlag = 1;
}

bool interrupted() {
    return interruptFlag != 0;
}

void stopIfInterrupted() {
    if (interrupted()) throw Error("interrupted", "", "nothing was written");
}

}  // namespace lumulus
