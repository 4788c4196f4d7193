#pragma once

#include <string>

#include "light/photon/slab.h"

namespace lumulus::cli {

struct SlabOptions {
    photon::Slab slab;
    std::string device;
    bool reference = false;  ///< use the reference's tracer instead of the photon walk
    bool json = false;
};

/// Runs `lumulus slab`: prints the fractions of the flux that a plane-parallel layer reflects, transmits and absorbs.
/// Errors: InputError for values out of range, Error where interrupted.
void runSlab(const SlabOptions& options);

}  // namespace lumulus::cli
