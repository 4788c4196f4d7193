#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "reference/phase.h"
#include "reference/random.h"

namespace lumulus::reference {

/// The sky around the sun as it is seen from within a cloud of a narrow phase function: bright by light that was turned
/// by little. Paths are as unlikely to go there by chance as they are worth much once they do, so a path sends a
/// *branch* there wherever it scatters. Its direction is drawn from a Henyey–Greenstein lobe about the sun with a peak
/// as high as that of the phase function, but no narrower than the sun's disc.
class Aureole {
  public:
    /// Absent where the lobe would be wide: then paths find the bright directions themselves. `angularRadius` of the
    /// sun in radians.
    static std::optional<Aureole> of(const PhaseFunction& phase, const glm::dvec3& sunDirection, double angularRadius);

    /// Branches that a scattering sends into a direction, 1/sr: one in all.
    double density(const glm::dvec3& direction) const;

    /// How many times more light is expected from this direction than from elsewhere: as many as the lobe exceeds its
    /// mean over the sphere. A third of it lets fireflies through.
    double importance(const glm::dvec3& direction) const;

    /// The direction of a branch.
    glm::dvec3 sample(Random& random) const;

  private:
    Aureole(const PhaseFunction& lobe, const glm::dvec3& sunDirection) : lobe_(lobe), sunDirection_(sunDirection) {}

    PhaseFunction lobe_;
    glm::dvec3 sunDirection_;
};

}  // namespace lumulus::reference
