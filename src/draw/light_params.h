#pragma once

#include "medium/scattering_tables.h"
#include "scene/scene.h"
#include "shared/draw.h"

namespace lumulus::draw {

/// Lights and medium for the drawing passes.
shared::LightParams lightParams(const scene::Sun& sun, const scene::Sky& sky, const glm::dvec3& albedo,
                                const phase::ScatteringTables& tables);

}  // namespace lumulus::draw
