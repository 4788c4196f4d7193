#pragma once

#include <optional>
#include <string>

#include "scene/scene.h"

namespace lumulus::phase {

/// A sentence about the factor by which the table of a phase function had to be normalised; nothing for other models
/// and where the table was normalised already. Errors: InputError as PhaseFunction.
std::optional<std::string> normalisationNote(const scene::Phase& phase);

}  // namespace lumulus::phase
