#pragma once

#include <memory>

namespace lumulus {

/// Thrown by a renderer that is being made where a field has no values, and its asset is not kept: the clouds are to be
/// loaded.
struct DensityMissing {};

/// What a renderer keeps for the next one on its device, beside which it does not live: prepared clouds, which are
/// taken where the next one has the same fields in the same detail, and the tables of the air. Each renderer that is
/// given it leaves in it what it needs itself, and drops the rest. Clouds in bricks are taken where all fields are laid
/// out as before. The pictures are those of renderers that begin anew. Not for clouds of flat voxels.
class KeptClouds {
  public:
    KeptClouds();
    KeptClouds(KeptClouds&&) noexcept;
    KeptClouds& operator=(KeptClouds&&) noexcept;
    ~KeptClouds();

    struct State;
    State& state() { return *state_; }

  private:
    std::unique_ptr<State> state_;
};

}  // namespace lumulus
