#pragma once

#include <limits>

#include "base/interrupt.h"

namespace lumulus::vdb {

/// Bounds of reading a file.
struct ReadLimits {
    /// Asked between pieces of the file and of the field, on any thread, by several at once. What it throws ends the
    /// work.
    Check check = stopIfInterrupted;
    /// MiB that the trees of a file may take while they are in memory.
    double treeMiB = std::numeric_limits<double>::infinity();
};

}  // namespace lumulus::vdb
