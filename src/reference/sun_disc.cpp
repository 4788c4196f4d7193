#include "reference/sun_disc.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "reference/phase.h"

namespace lumulus::reference {
namespace {

constexpr double limb0 = 0.3, limb1 = 0.93, limb2 = -0.23;
/// ∫₀¹ of the limb's law over u = 1 − c², the share of the disc's solid angle, and of u times it.
constexpr double limbMean = limb0 + limb1 * 2.0 / 3.0 + limb2 / 2.0;
constexpr double limbMoment = limb0 / 2.0 + limb1 * 4.0 / 15.0 + limb2 / 6.0;

}  // namespace

SunDisc::SunDisc(const scene::Sun& sun)
    : direction_(glm::normalize(sun.directionTo)),
      radius_(0.5 * glm::radians(sun.angularDiameter)),
      limb_(sun.limbDarkening && sun.angularDiameter > 0.0) {
    cone_ = 2.0 * std::sin(0.5 * radius_) * std::sin(0.5 * radius_);
    // an even disc has E = L π sin², and ∫ L dω = L 2π (1 − cos)
    fluence_ = limb_ ? 1.0 / (1.0 - cone_ * limbMoment / limbMean) : 2.0 / (2.0 - cone_);
    if (!(radius_ > 0.0)) return;
    meanRadiance_ = limb_ ? fluence_ / (glm::two_pi<double>() * cone_)
                          : 1.0 / (glm::pi<double>() * std::sin(radius_) * std::sin(radius_));
}

glm::dvec3 SunDisc::sample(Random& random) const {
    const double oneMinusCos = cone_ * random.uniform();
    return cone_ > 0.0 ? turned(direction_, oneMinusCos, random) : direction_;
}

double SunDisc::limb(const glm::dvec3& direction) const {
    if (!limb_) return 1.0;
    const double square = std::max(0.0, 1.0 - oneMinusCosBetween(direction, direction_) / cone_);
    return (limb0 + limb1 * std::sqrt(square) + limb2 * square) / limbMean;
}

double SunDisc::relativeRadiance(const glm::dvec3& direction) const {
    return oneMinusCosBetween(direction, direction_) < cone_ ? limb(direction) : 0.0;
}

}  // namespace lumulus::reference
