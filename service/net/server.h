#pragma once

#include "service/net/config.h"

namespace lumulus::service {

/// Serves frames until SIGTERM or SIGINT, then finishes or fails what it promised.
/// Errors: InputError before it listens: bad scenes, addresses that are taken.
void serve(const Config& config);

}  // namespace lumulus::service
