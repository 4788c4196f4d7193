#include "reference/environment.h"

#include <glm/gtx/component_wise.hpp>

namespace lumulus::reference {

Environment::Environment(const scene::Scene& scene)
    : unit_(scene.sky.radiance),
      sun_(scene.sun),
      sunFluence_(scene.sun.irradiance * sun_.fluence()),
      meanDiscRadiance_(scene.sun.irradiance * sun_.meanRadiance()),
      sunny_(glm::compMax(sunFluence_) > 0.0) {}

}  // namespace lumulus::reference
