#pragma once

#include "cli/render.h"

namespace lumulus::cli {

/// Runs `lumulus render --frames`: the frames one after the other in one process. A frame that fails is told at the
/// end, and the others are there. Errors: InputError before any work for what is wrong with the options or with the
/// scene at any frame; Error where frames failed.
void runFrames(const RenderOptions& options);

}  // namespace lumulus::cli
