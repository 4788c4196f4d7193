#include "draw/light_params.h"

#include <cmath>
#include <numbers>

namespace lumulus::draw {

shared::LightParams lightParams(const scene::Sun& sun, const scene::Sky& sky, const glm::dvec3& albedo,
                                const phase::ScatteringTables& tables) {
    shared::LightParams light{};
    const double radius = 0.5 * sun.angularDiameter * std::numbers::pi / 180.0;
    const double sine = std::sin(radius);
    light.sunTravel = glm::vec3(-sun.directionTo);
    light.sunIrradiance = glm::vec3(sun.irradiance);
    light.sunDisc = sine > 0.0 ? glm::vec3(sun.irradiance / (std::numbers::pi * sine * sine)) : glm::vec3(0.0F);
    light.sunCone = sine > 0.0 ? static_cast<float>(2.0 * std::pow(std::sin(0.5 * radius), 2)) : -1.0F;
    light.skyRadiance = glm::vec3(sky.radiance);
    light.albedo = glm::vec3(albedo);
    light.extinctionScale = glm::vec3(1.0 - static_cast<double>(tables.forwardFraction) * albedo);
    light.scatterShare = tables.scatterFraction;
    light.angleScale = tables.angleScale;
    light.tauMaximum = tables.tauMaximum;
    return light;
}

}  // namespace lumulus::draw
