#pragma once

#include <glm/glm.hpp>

#include "reference/air_medium.h"
#include "reference/sky_map.h"
#include "reference/sun_disc.h"
#include "scene/scene.h"

namespace lumulus::reference {

/// What lies behind the air of an atmosphere: the sun, whose light counts as 1 at each wavelength above the air, and
/// the night sky of 1.9e-4 cd/m² where the sun has that of its mean distance. It has the functions of `Environment`, at
/// four wavelengths. All light is per sunlight above the air; `rgb` makes W·m⁻² of it: where the scene's
/// `sun.irradiance` is not that of the sun at its mean distance, each channel is scaled by their ratio.
class AirSky {
  public:
    explicit AirSky(const scene::Scene& scene);

    Four radiance(const glm::dvec3& /*direction*/) const { return night_; }
    Four relativeRadiance(const glm::dvec3& /*direction*/) const { return night_; }
    glm::dvec3 unit() const { return glm::dvec3(1.0); }

    bool aimed() const { return false; }
    SkyMapSample sample(Random& /*random*/) const { return {}; }
    double density(const glm::dvec3& /*direction*/) const { return 0.0; }

    const SunDisc& sun() const { return sun_; }
    bool sunny() const { return sunny_; }
    /// 1/sr.
    Four discRadiance(const glm::dvec3& direction) const {
        return Four(sunny_ ? sun_.meanRadiance() * sun_.relativeRadiance(direction) : 0.0);
    }
    Four sunFluence() const { return Four(sunny_ ? sun_.fluence() : 0.0); }

    const AirMedium& air() const { return air_; }

    glm::dvec3 rgb(const Four& light) const { return scale_ * (air_.toRgb * light); }
    Four albedo(const glm::dvec3& rgb) const { return air_.spread(rgb); }
    Four emission(const glm::dvec3& rgb) const { return air_.lightOf(rgb * unscale_); }

  private:
    AirMedium air_;
    SunDisc sun_;
    bool sunny_;
    Four night_{0.0};
    glm::dvec3 scale_{1.0}, unscale_{1.0};
};

}  // namespace lumulus::reference
