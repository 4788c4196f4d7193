#include "reference/aureole.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace lumulus::reference {
namespace {

constexpr double fourPi = 4.0 * glm::pi<double>();

/// 1 − g of the widest lobe that is worth its branches in every view. At 0.15 branches save half of the time to an
/// error where the camera looks away from the sun and cost three times as much where it looks towards it
/// (docs/experiments/path-tracer-noise.md).
constexpr double widest = 0.1;

/// 1 − g of the narrowest lobe; in narrower ones the rounding of directions would show.
constexpr double narrowest = 1e-9;

/// 1 − g of the Henyey–Greenstein lobe with this peak [1/sr]: 4π·peak = (1+g)/(1−g)².
double widthOf(double peak) {
    const double p = fourPi * peak;
    return 4.0 / (1.0 + std::sqrt(1.0 + 8.0 * p));
}

}  // namespace

std::optional<Aureole> Aureole::of(const PhaseFunction& phase, const glm::dvec3& sunDirection, double angularRadius) {
    const double width = std::max({widthOf(phase.peak()), angularRadius, narrowest});
    if (width > widest) return std::nullopt;
    scene::Phase lobe;
    lobe.model = scene::PhaseModel::henyeyGreenstein;
    lobe.g = 1.0 - width;
    return Aureole(PhaseFunction(lobe), sunDirection, phase.returns());
}

double Aureole::density(const glm::dvec3& direction) const {
    const double about = lobe_.evaluate(oneMinusCosBetween(sunDirection_, direction));
    if (!opposite_) return about;
    return 0.5 * (about + lobe_.evaluate(oneMinusCosBetween(-sunDirection_, direction)));
}

double Aureole::importance(const glm::dvec3& direction) const {
    return 1.0 + fourPi * density(direction);
}

glm::dvec3 Aureole::sample(Random& random) const {
    const bool away = opposite_ && random.uniform() < 0.5;
    return turned(away ? -sunDirection_ : sunDirection_, lobe_.sample(random), random);
}

}  // namespace lumulus::reference
