#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "gpu/program.h"
#include "phase/scattering_tables.h"
#include "shared/photon.h"

/// The photon walk's program, which clouds and plane-parallel layers share.
namespace lumulus::photon {

std::span<const std::uint32_t> traceSpirv();

/// Variants by what the medium needs; `periodic`: a layer that goes on for ever in x and z.
std::vector<gpu::SpecConstant> traceConstants(const phase::ScatteringTables& tables, const glm::dvec3& albedo,
                                              bool periodic);

/// No photon alive; invocation i begins with photon i.
void resetStates(std::span<shared::TraceState> states);

}  // namespace lumulus::photon
