#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/progress.h"
#include "vdb/volume.h"

namespace lumulus::vdb {

struct ProceduralOptions {
    std::string kind = "cumulus";
    int resolution = 128;  ///< voxels along the longest side, with the ring; 8 to 1024
    std::uint64_t seed = 1;
};

/// The names that `makeCloud` knows.
std::vector<std::string> kinds();

/// Makes a cloud with densities in 0..1, in metres, with its base at y = 0 and its middle above the origin. The same
/// options give the same cloud on every machine (up to the last bits of the floats).
///   cumulus  about 1000 m wide and 650 m high: flat base, billows of all sizes down to the voxel, dense inside
///   stratocumulus  1000 × 250 × 1000 m: one cell of a deck, which such cells close side by side
///   stratus  2000 × 200 × 2000 m: a deck of cells with a wavy top and gaps
///   cirrus   2400 × 600 × 1500 m: thin hooks that trail in the wind shear
///   sphere   a homogeneous ball of density 1 and radius 100 m
///   slab     a homogeneous box of density 1, 400 × 100 × 400 m
/// `sphere` and `slab` hold the covered fraction of each voxel, so that their masses are those of the exact shapes.
/// Throws InputError for an unknown kind or a resolution out of range, Error where interrupted.
Volume makeCloud(const ProceduralOptions& options, const Report& report = noReport);

}  // namespace lumulus::vdb
