#pragma once

#include <string>

#include "renderer.h"

namespace lumulus::cli {

/// What --stats writes: one JSON object and a newline. Seconds of writing and of everything come from the caller.
std::string statisticsJson(const Statistics& statistics, double writeSeconds, double totalSeconds);

}  // namespace lumulus::cli
