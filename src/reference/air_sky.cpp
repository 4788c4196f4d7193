#include "reference/air_sky.h"

#include <glm/gtx/component_wise.hpp>

namespace lumulus::reference {

AirSky::AirSky(const scene::Scene& scene)
    : air_(AirMedium::of(scene.sky)), sun_(scene.sun), sunny_(glm::compMax(scene.sun.irradiance) > 0.0) {}

}  // namespace lumulus::reference
