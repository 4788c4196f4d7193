#pragma once

#include <cstdint>

/// The SPIR-V of the shaders that test shaders/shared.
namespace lumulus::test {
#include "spirv/stat/shaders/evaluate_sh.comp.h"
#include "spirv/stat/shaders/sample_hg.comp.h"
}  // namespace lumulus::test
