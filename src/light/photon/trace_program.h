#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "gpu/program.h"
#include "medium/scattering_tables.h"
#include "shared/photon.h"

/// The photon walk's program, which clouds and plane-parallel layers share.
namespace lumulus::photon {

std::span<const std::uint32_t> traceSpirv();

/// Variants by what the medium needs; `periodic`: a layer that goes on for ever in x and z; `air`: light
/// of an atmosphere.
std::vector<gpu::SpecConstant> traceConstants(const phase::ScatteringTables& tables, const glm::dvec3& albedo,
                                              bool periodic, bool air = false);

/// The faces of the box that photons enter by, with these area vectors [m²]; `p.sunDirection` must be set.
void setFaces(shared::TraceParams& p, const glm::dmat3& faceArea);

/// No photon alive; invocation i begins with photon i.
void resetStates(std::span<shared::TraceState> states);

}  // namespace lumulus::photon
