#pragma once

#include <cstddef>
#include <span>

namespace lumulus::service {

/// Halves of several planes of floats, pixel by pixel: `out` holds `count` pixels of `planes.size()` halves each.
/// Rounds to the nearest even, bit for bit as Imath (and so OpenEXR) does, NaNs included; by the machine's instruction
/// for it (F16C) where there is one.
void interleaveHalves(std::span<const float* const> planes, std::size_t count, std::byte* out);

/// The same without that instruction.
void interleaveHalvesPlainly(std::span<const float* const> planes, std::size_t count, std::byte* out);

}  // namespace lumulus::service
