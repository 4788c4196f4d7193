#pragma once

#include <cstdint>

/// The SPIR-V of the test shaders.
namespace lumulus::test {
#include "spirv/gpu/shaders/copy.comp.h"
#include "spirv/gpu/shaders/fetch_integers.comp.h"
#include "spirv/gpu/shaders/halve_layers.comp.h"
#include "spirv/gpu/shaders/layout.comp.h"
#include "spirv/gpu/shaders/sample_level.comp.h"
#include "spirv/gpu/shaders/sample_volume.comp.h"
#include "spirv/gpu/shaders/scale.comp.h"
#include "spirv/gpu/shaders/store_formats.comp.h"
#include "spirv/gpu/shaders/store_half.comp.h"
#include "spirv/gpu/shaders/sum.comp.h"
#include "spirv/gpu/shaders/unsupported.comp.h"
}  // namespace lumulus::test
