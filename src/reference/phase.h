#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "reference/phase_values.h"
#include "reference/random.h"
#include "scene/scene.h"

namespace lumulus::reference {

/// 1 − cos of the angle between two unit vectors, with all its digits where they are nearly parallel.
inline double oneMinusCosBetween(const glm::dvec3& a, const glm::dvec3& b) {
    const glm::dvec3 difference = a - b;
    return 0.5 * glm::dot(difference, difference);
}

/// The reference's own phase functions, in double: p in 1/sr with ∫ p dω = 1, as a function of the angle between the
/// directions of travel before and after scattering, given as 1 − cos θ. All samplers are exact (pdf = p).
class PhaseFunction {
  public:
    /// Errors: InputError for parameters without a phase function.
    explicit PhaseFunction(const scene::Phase& phase);

    /// Aerosol (Cornette and Shanks 1992); |g| below 1.
    static PhaseFunction cornetteShanks(double g);

    /// Value of p [1/sr].
    double evaluate(double oneMinusCos) const;

    /// The larger of p straight on and straight back [1/sr].
    double peak() const;
    /// Whether p straight back is larger than straight on.
    bool returns() const { return evaluate(2.0) > evaluate(0.0); }

    /// Draws 1 − cos θ of a scattering event, in [0, 2].
    double sample(Random& random) const;

    /// p of red, green and blue over `evaluate`; 1 but for droplets by Mie's theory.
    glm::dvec3 hue(double oneMinusCos) const;
    bool coloured() const { return values_.size() > 1; }

  private:
    scene::PhaseModel model_;
    double g_ = 0.0;  ///< of Henyey–Greenstein; Schlick's k
    // droplets: (1 − share)·HG(g) + share·Draine(draineG, draineAlpha)
    double draineG_ = 0.0;
    double draineAlpha_ = 0.0;
    double draineShare_ = 0.0;
    std::vector<PhaseValues> values_;  ///< of models by values: red, green, blue and their mean, or one for all
};

/// The unit vector at an angle θ from `direction`, given as 1 − cos θ, with a random azimuth.
glm::dvec3 turned(const glm::dvec3& direction, double oneMinusCos, Random& random);

}  // namespace lumulus::reference
