#pragma once

#include <array>
#include <optional>

#include "reference/fog_density.h"

namespace lumulus::reference {

/// One fog medium along a whole ray, between its bottom and its top: planes, or shells around a planet, of which a ray
/// may cross the upper one twice.
class FogOnRay {
  public:
    /// `planet`: as for FogDensity.
    FogOnRay(const scene::FogMedium& medium, const Ray& ray, const std::optional<double>& planet);

    /// ∫ ϱ from the ray's origin to `metres`; at most 2e200.
    double pathTo(double metres) const { return parts_[0].pathTo(metres) + parts_[1].pathTo(metres); }

    /// Metres at which the integral reaches `path`; infinity if it never does.
    double metresTo(double path) const;

  private:
    std::array<FogDensity, 2> parts_;  ///< in the order of the ray
};

}  // namespace lumulus::reference
