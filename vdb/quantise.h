#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "base/interrupt.h"
#include "vdb/volume.h"

namespace lumulus::vdb {

/// Texel formats of a density texture: 8-bit normalised, 16-bit and 32-bit float.
enum class DensityFormat { r8, r16f, r32f };

struct QuantisedVolume {
    DensityFormat format = DensityFormat::r8;
    std::vector<std::byte> texels;  ///< density / maximum, in the order of the volume, native endian
    double relativeError = 0.0;     ///< Σ|q − v| / Σ v over all voxels
};

/// Bytes of one texel.
std::size_t texelBytes(DensityFormat format);

/// Texel number `place` as shaders see it.
float texelValue(std::span<const std::byte> texels, std::size_t place, DensityFormat format);

/// Divides by the maximum, which is stored exactly as 1, and takes the smallest format whose measured relative error is
/// at most 1e-3; R32F is the last choice. Rounds to nearest (half floats: ties to even). An empty volume gives zeros in
/// R8. `check` is asked between pieces, by several threads at once. Errors: what it throws.
QuantisedVolume quantise(const Volume& volume, const Check& check = stopIfInterrupted);

}  // namespace lumulus::vdb
