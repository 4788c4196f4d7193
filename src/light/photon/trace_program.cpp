#include "light/photon/trace_program.h"

#include <algorithm>
#include <cmath>

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
                                              bool periodic, bool air) {
    const bool absorbs = std::min(albedo.x, std::min(albedo.y, albedo.z)) < 1.0;
    return {gpu::SpecConstant::of(0, tables.analyticHg),
            gpu::SpecConstant::of(1, tables.forwardFraction > 0.0F),
            gpu::SpecConstant::of(2, absorbs),
            gpu::SpecConstant::of(3, periodic),
            gpu::SpecConstant::of(4, !periodic && !tables.axisTable.empty()),
            gpu::SpecConstant::of(5, air)};
}

void setFaces(shared::TraceParams& p, const glm::dmat3& faceArea) {
    const glm::dvec3 sunDirection(p.sunDirection);
    double through = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        p.faceArea[axis] = glm::vec3(faceArea[axis]);
        p.faceSize[axis] = static_cast<float>(glm::length(faceArea[axis]));
        through += std::abs(glm::dot(faceArea[axis], sunDirection));
    }
    p.sunThrough = static_cast<float>(through);
}

void resetStates(std::span<shared::TraceState> states) {
    for (std::size_t i = 0; i < states.size(); ++i) {
        states[i] = shared::TraceState{};
        states[i].photon = static_cast<std::uint32_t>(i);
    }
}

}  // namespace lumulus::photon
