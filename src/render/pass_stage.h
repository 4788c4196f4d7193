#pragma once

#include <string_view>

#include "base/pass_time.h"

namespace lumulus {

/// The stage for which a pass of the renderer works, by the name of the pass in the times of commands.
/// Throws std::logic_error for a pass that is not listed: a new pass has to say what its costs belong to.
Stage stageOf(std::string_view pass);

}  // namespace lumulus
