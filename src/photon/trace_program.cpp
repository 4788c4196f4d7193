#include "photon/trace_program.h"

#include <algorithm>

namespace lumulus::photon {

namespace {

namespace spirv {
#include "spirv/photon/trace.comp.h"
}  // namespace spirv

}  // namespace

std::span<const std::uint32_t> traceSpirv() {
    return spirv::trace_comp;
}

std::vector<gpu::SpecConstant> traceConstants(const phase::ScatteringTables& tables, const glm::dvec3& albedo,
                                              bool periodic) {
    const bool absorbs = std::min(albedo.x, std::min(albedo.y, albedo.z)) < 1.0;
    return {gpu::SpecConstant::of(0, tables.analyticHg), gpu::SpecConstant::of(1, tables.forwardFraction > 0.0F),
            gpu::SpecConstant::of(2, absorbs), gpu::SpecConstant::of(3, periodic)};
}

void resetStates(std::span<shared::TraceState> states) {
    for (std::size_t i = 0; i < states.size(); ++i) {
        states[i] = shared::TraceState{};
        states[i].photon = static_cast<std::uint32_t>(i);
    }
}

}  // namespace lumulus::photon
