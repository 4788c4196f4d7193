#pragma once

#include "service/net/config.h"

namespace lumulus::service {

/// Serves frames until SIGTERM or SIGINT, and then finishes the frames that wait, or answers them with an error.
/// Errors: InputError before it listens, for bad scenes and addresses that are taken.
void serve(const Config& config);

}  // namespace lumulus::service
