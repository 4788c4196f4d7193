#include "reference/air_sky.h"

#include <glm/gtx/component_wise.hpp>

namespace lumulus::reference {

AirSky::AirSky(const scene::Scene& scene)
    : air_(AirMedium::of(scene.sky)), sun_(scene.sun), sunny_(glm::compMax(scene.sun.irradiance) > 0.0) {
    if (!sunny_) return;
    scale_ = scene.sun.irradiance / (air_.toRgb * Four(1.0));
    constexpr double candelas = 1.9e-4, lumensPerWatt = 683.0;  // 21.9 mag/arcsec²
    night_ = air_.lightOf(glm::dvec3(candelas / lumensPerWatt));
    for (int c = 0; c < 3; ++c) unscale_[c] = scale_[c] > 0.0 ? 1.0 / scale_[c] : 0.0;
}

}  // namespace lumulus::reference
