#pragma once

#include <cstdint>
#include <vector>

#include "gpu/commands.h"
#include "gpu/program.h"
#include "light/photon/photon_map.h"
#include "light/photon/world_walk.h"

namespace lumulus::photon {

/// Where photons of a walk through several clouds begin in the next round. They are found before the walk, all lanes at
/// once.
class PhotonStarts {
  public:
    /// The walk must outlive it.
    PhotonStarts(gpu::Context& context, const WorldWalk& walk, const Options& options, std::uint32_t invocations);

    /// Records it (with a barrier after it) for a round of so many steps. `bindings`: what the walk's program binds
    /// besides those of WorldWalk::bindings().
    void record(gpu::Commands& commands, const std::vector<gpu::Binding>& bindings, std::uint32_t steps) const;
    gpu::Binding binding() const { return {"starts", starts_}; }

  private:
    const WorldWalk& walk_;
    std::uint32_t invocations_, most_;
    gpu::Program<gpu::NoPush> program_;
    gpu::Buffer starts_;
};

}  // namespace lumulus::photon
