#include "draw/light_params.h"

#include <cmath>
#include <numbers>

namespace lumulus::draw {

shared::LightParams lightParams(const scene::Sun& sun) {
    shared::LightParams light{};
    const double radius = 0.5 * sun.angularDiameter * std::numbers::pi / 180.0;
    const double sine = std::sin(radius);
    light.sunTravel = glm::vec3(-sun.directionTo);
    light.sunDisc = sine > 0.0 ? glm::vec3(sun.irradiance / (std::numbers::pi * sine * sine)) : glm::vec3(0.0F);
    light.sunCone = sine > 0.0 ? static_cast<float>(2.0 * std::pow(std::sin(0.5 * radius), 2)) : -1.0F;
    return light;
}

}  // namespace lumulus::draw
