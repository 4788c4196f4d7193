#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "medium/shared_table.h"
#include "scene/scene.h"

namespace lumulus::phase {

/// All tables that the GPU needs for one phase function, cut angle θc and albedo; shared/phase_table.h has their axes.
struct ScatteringTables {
    float forwardFraction = 0.0F;  ///< f = P(θ < θc)
    float scatterFraction = 1.0F;  ///< 1 − f without cancellation
    /// χ'_l = b_l/(1−f), l = 0..bands−1: the moments of p restricted to θ ≥ θc; 0 for bands that rings take over.
    std::vector<float> bandMoments;

    bool analyticHg = false;  ///< true: sample with sampleHg(g, u, scatterFraction); false: with inverseCdf
    float g = 0.0F;           ///< mean cosine of the whole p; the parameter of Henyey–Greenstein

    /// 1 − cos θ of p restricted to θ ≥ θc, inverseCdfCells + 1 entries, looked up with inverseCdfCell(u); empty for
    /// Henyey–Greenstein.
    SharedTable inverseCdf;

    float angleScale = 1.0F;  ///< for angleToAxis
    /// What rings about the sun's axis scatter beyond the bands (sun_axis.h); empty where the phase function has no
    /// backward peak.
    SharedTable axisTable;
    /// ln p [ln 1/sr], p averaged over the sun's disc, phaseTableSize entries, looked up with
    /// tableCell(angleToAxis(angle, angleScale), phaseTableSize); where colours differ, red, green and blue of each
    /// entry.
    SharedTable phaseTable;
    bool coloured = false;  ///< whether p differs between colours; everything else holds their mean by luminance

    /// The smooth parts of the sun's light that scattered once (single_scattering.h), divided by
    /// exp(−extinctionScale·τ), RGB, singleScatterAngleCount × singleScatterTauCount; both empty (H = K = 0) where θc =
    /// 0.
    SharedTable singleScatterH;       ///< of (τs, θ); the whole term carries e^−τv
    SharedTable singleScatterK;       ///< of (τs + τv, θ)
    float tauMaximum = 1.0F;          ///< for tauToAxis
    glm::vec3 extinctionScale{1.0F};  ///< 1 − ω f per channel
};

/// Makes the tables. `cutRadians` θc in [0, π); `albedo` ω in [0,1]; `bands` ≥ 1; `sunAngularDiameterRadians` ≥ 0.
/// Errors: InputError as PhaseFunction.
ScatteringTables makeScatteringTables(const scene::Phase& phase, double cutRadians, const glm::dvec3& albedo, int bands,
                                      double sunAngularDiameterRadians);

}  // namespace lumulus::phase
