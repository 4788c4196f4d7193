#pragma once

#include <string>

#include "photon/slab.h"

namespace lumulus::cli {

struct SlabOptions {
    photon::Slab slab;
    std::string device;
    bool json = false;
};

/// `lumulus slab`: fractions of the flux that a plane-parallel layer reflects, transmits and absorbs.
void runSlab(const SlabOptions& options);

}  // namespace lumulus::cli
