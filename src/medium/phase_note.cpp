#include "medium/phase_note.h"

#include <fmt/format.h>

#include <cmath>

#include "medium/phase_function.h"

namespace lumulus::phase {

std::optional<std::string> normalisationNote(const scene::Phase& phase) {
    if (phase.model != scene::PhaseModel::table) return std::nullopt;
    const double factor = PhaseFunction(phase).table()->factor();
    if (std::abs(factor - 1.0) < 1e-4) return std::nullopt;
    return fmt::format("the phase function of {} was multiplied by {:.6g} so that it integrates to 1 over the sphere",
                       phase.table.string(), factor);
}

}  // namespace lumulus::phase
