#pragma once

#include <cstdint>

#include "scene/scene.h"

namespace lumulus::reference {

/// A plane-parallel homogeneous layer over a black ground, lit by a parallel beam from above.
struct Slab {
    double tau = 1.0;     ///< optical thickness
    scene::Phase phase;   ///< as for clouds
    double albedo = 1.0;  ///< 0…1
    double mu0 = 1.0;     ///< cosine of the beam's angle to the vertical, above 0
    std::uint64_t photons = 1'000'000;
    std::uint64_t seed = 1;
};

/// A mean and its standard error.
struct Estimate {
    double value = 0.0;
    double standardError = 0.0;
};

/// Fractions of the incident flux; they add up to 1.
struct SlabResult {
    Estimate reflected;
    Estimate transmittedDiffuse;
    Estimate transmittedDirect;  ///< exact
    Estimate absorbed;
};

/// Traces photons through the layer. Every photon collides at least once; direct transmission is computed exactly. The
/// same seed gives the same bits on any number of threads. Errors: InputError for values out of range, Error if
/// interrupted.
SlabResult solveSlab(const Slab& slab);

}  // namespace lumulus::reference
