#pragma once

#include <pybind11/pybind11.h>

#include <functional>

#include "base/interrupt.h"
#include "base/progress.h"

namespace lumulus::python {

/// What long work calls between its steps.
struct Hooks {
    Report report = noReport;
    Check check = stopIfInterrupted;
};

/// Runs work on a thread of its own while Python's other threads go on, and waits for it. Ctrl-C, what another handler
/// of signals throws and what `progress` throws (a function of step, done and total, or None) end the work, and are
/// thrown here. Call with the GIL held. Errors: those of the work.
void run(const pybind11::object& progress, const std::function<void(const Hooks&)>& work);

/// Gives each warning to Python's warnings module.
void warn(const std::string& text);

}  // namespace lumulus::python
