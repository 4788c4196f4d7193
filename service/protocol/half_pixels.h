#pragma once

#include <cstddef>
#include <span>

namespace lumulus::service {

/// Converts several planes of floats to half precision, pixel by pixel: `out` holds `count` pixels of `planes.size()`
/// half-precision numbers each. Rounds to the nearest even, bit for bit as Imath (and so OpenEXR) does, NaNs included.
/// Uses the processor's instruction for it (F16C) where there is one.
void interleaveHalves(std::span<const float* const> planes, std::size_t count, std::byte* out);

/// The same without that instruction.
void interleaveHalvesPlainly(std::span<const float* const> planes, std::size_t count, std::byte* out);

}  // namespace lumulus::service
