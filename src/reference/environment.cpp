#include "reference/environment.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "reference/phase.h"

namespace lumulus::reference {

Environment::Environment(const scene::Sky& sky, const scene::Sun& sun)
    : unit_(sky.radiance),
      sunDirection_(glm::normalize(sun.directionTo)),
      sunRadius_(0.5 * glm::radians(sun.angularDiameter)) {
    const double radius = sunRadius_;
    sunCone_ = 2.0 * std::sin(0.5 * radius) * std::sin(0.5 * radius);
    // irradiance counts the disc's points by the cosine to its middle: E = L π sin²; the fluence does not: L 2π(1 −
    // cos)
    sunFluence_ = sun.irradiance * (2.0 / (2.0 - sunCone_));
    if (radius > 0.0) discRadiance_ = sun.irradiance / (glm::pi<double>() * std::sin(radius) * std::sin(radius));
    sunny_ = std::max({sunFluence_.x, sunFluence_.y, sunFluence_.z}) > 0.0;
}

glm::dvec3 Environment::discRadiance(const glm::dvec3& point, const glm::dvec3& direction) const {
    const bool within = oneMinusCosBetween(direction, sunDirection_) < sunCone_;
    return within ? discRadiance_ * sunTransmittance(point) : glm::dvec3(0.0);
}

glm::dvec3 Environment::sampleSun(Random& random) const {
    const double oneMinusCos = sunCone_ * random.uniform();
    return sunCone_ > 0.0 ? turned(sunDirection_, oneMinusCos, random) : sunDirection_;
}

}  // namespace lumulus::reference
