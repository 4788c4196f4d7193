#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "vdb/quantise.h"

/// Texels of bricks: R8 between the least and the greatest value of a brick, or half floats (inside vdb/ only).
namespace lumulus::vdb {

/// The density is low + span · texel.
struct CodeRange {
    float low = 0.0F, span = 0.0F;
};

std::uint32_t packRange(const CodeRange& range);
CodeRange unpackRange(std::uint32_t packed);

/// Errors of storing values, summed up.
struct CodeError {
    double values = 0.0, errors = 0.0;  ///< Σ v, Σ|q − v|

    double relative() const { return values > 0.0 ? errors / values : 0.0; }
};

/// Stores values ≥ 0 as texels; `codes` has room for them. Zero stays zero, and the greatest value is kept up to
/// 1/1024 above it (exactly where half floats have it). Returns the range, whose span is above 0, as unpackRange()
/// gives it back. Adds the error to `error`.
CodeRange encode(std::span<const float> values, DensityFormat format, std::span<std::byte> codes, CodeError& error);

}  // namespace lumulus::vdb
