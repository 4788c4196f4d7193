#pragma once

#include <cstdint>

#include "gpu/context.h"
#include "scene/scene.h"

namespace lumulus::photon {

/// A plane-parallel layer over a black ground, lit from above at the cosine mu0.
struct Slab {
    double tau = 1.0;
    double albedo = 1.0;
    double mu0 = 1.0;  ///< in (0, 1]
    scene::Phase phase;
    std::uint64_t photons = 4000000;
    std::uint64_t seed = 1;
};

/// A fraction of the incident flux, with its standard error (binomial).
struct SlabFraction {
    double value = 0.0;
    double standardError = 0.0;
};

struct SlabResult {
    SlabFraction reflected, transmittedDiffuse, transmittedDirect, absorbed;
    std::uint64_t events = 0;
    std::uint64_t lost = 0;  ///< photons that met the collision limit
};

/// Traces the layer, laterally periodic, with the photon walk that clouds use; the forward peak is never cut.
/// Errors: InputError for values out of range.
SlabResult traceSlab(gpu::Context& context, const Slab& slab);

}  // namespace lumulus::photon
