#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "reference/phase.h"
#include "reference/random.h"

namespace lumulus::reference {

/// The bright sky around the sun, as it is seen from within a cloud with a narrow phase function. Paths rarely go there
/// by chance but carry much light when they do, so a path sends a *branch* there at each scattering event. Its
/// direction is drawn from a Henyey–Greenstein lobe about the sun with a peak as high as that of the phase function,
/// but no narrower than the sun's disc. Where the peak is backward, light goes to and fro along the sun's axis: half of
/// the branches go to a lobe about the point opposite the sun.
class Aureole {
  public:
    /// Makes an aureole, or nothing where the lobe is so wide that paths find the bright directions by themselves.
    /// `angularRadius` is that of the sun in radians.
    static std::optional<Aureole> of(const PhaseFunction& phase, const glm::dvec3& sunDirection, double angularRadius);

    /// Density of the branches of one scattering event in a direction, 1/sr; its integral is one.
    double density(const glm::dvec3& direction) const;

    /// Expected light from this direction relative to the mean over all directions: the lobe over its mean. A third of
    /// this value lets fireflies through.
    double importance(const glm::dvec3& direction) const;

    /// Draws the direction of a branch.
    glm::dvec3 sample(Random& random) const;

  private:
    Aureole(const PhaseFunction& lobe, const glm::dvec3& sunDirection, bool opposite)
        : lobe_(lobe), sunDirection_(sunDirection), opposite_(opposite) {}

    PhaseFunction lobe_;
    glm::dvec3 sunDirection_;
    bool opposite_;  ///< there is a lobe about the point opposite the sun too
};

}  // namespace lumulus::reference
