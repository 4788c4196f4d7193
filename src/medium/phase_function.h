#pragma once

#include <optional>
#include <vector>

#include "medium/tabulated_phase.h"
#include "scene/scene.h"

namespace lumulus::phase {

/// Parameters of the mixture (1−weight)·HG(gHg) + weight·Draine(gDraine, alpha).
struct DropletFit {
    double gHg = 0.0;
    double gDraine = 0.0;
    double alpha = 0.0;
    double weight = 0.0;
};

/// Fog and cloud droplets of a diameter of 5 to 50 µm (Jendersie and d'Eon 2023, "An Approximate Mie Scattering
/// Function for Fog and Cloud Rendering").
DropletFit dropletFit(double diameter);

/// Schlick's k for an asymmetry g.
double schlickK(double g);

/// A phase function in double precision, against which all approximations are tested: p in 1/sr with ∫ p dω = 1, a
/// function of the angle θ between the directions of travel before and after scattering.
class PhaseFunction {
  public:
    /// Errors: InputError for parameters without a phase function: |g| ≥ 1, |g| so large that Schlick's k reaches 1
    /// (|g| ≥ 0.938), a droplet outside 5 to 50 µm, a radius outside 2 to 50 µm, a table that cannot be read. Of
    /// droplets whose colours differ (`mie`) it is the mean by luminance.
    explicit PhaseFunction(const scene::Phase& phase);

    /// A phase function by values at angles.
    explicit PhaseFunction(TabulatedPhase table);

    double evaluate(double cosTheta) const { return evaluate(1.0 - cosTheta, 1.0 + cosTheta); }
    /// Evaluates p from 1 − cos θ, which keeps its digits in a narrow forward lobe.
    double evaluateSmall(double oneMinusCos) const { return evaluate(oneMinusCos, 2.0 - oneMinusCos); }
    /// Evaluates p from θ in [0,π], with all digits in lobes at both poles.
    double evaluateAngle(double theta) const;

    /// χ_l = ∫ p P_l dω, l = 0..count−1, in closed form or, of a table, by quadrature; χ_0 = 1, χ_1 the mean cosine.
    std::vector<double> moments(int count) const;

    /// Share of light that is scattered by less than thetaCut [radians].
    double forwardFraction(double thetaCut) const;

    /// a_l = ∫ p P_l dω over θ < thetaCut [radians], l = 0..count−1.
    std::vector<double> forwardMoments(double thetaCut, int count) const;

    /// Width of the forward peak [radians]: roughly the angle within which p changes.
    double lobeWidth() const { return lobeWidth_; }

    /// The values at angles, of the models that have them; null for closed forms.
    const TabulatedPhase* table() const { return table_ ? &*table_ : nullptr; }

    /// Ends of panels that divide the angles [begin,end] ⊂ [0,π] so that one rule of 16 points suits p on each.
    std::vector<double> panels(double begin, double end) const;

  private:
    double evaluate(double oneMinusCos, double onePlusCos) const;

    scene::PhaseModel model_;
    double g_ = 0.0;
    double k_ = 0.0;
    DropletFit fit_;
    std::optional<TabulatedPhase> table_;
    double lobeWidth_ = 0.25;
};

/// A phase function for the eye.
struct PhaseColours {
    PhaseFunction mean;                   ///< by luminance
    std::vector<PhaseFunction> channels;  ///< of red, green and blue where they differ; none where all are the mean
};

/// Errors: as those of PhaseFunction.
PhaseColours phaseColours(const scene::Phase& phase);

}  // namespace lumulus::phase
