#pragma once

#include <array>
#include <functional>
#include <vector>

namespace lumulus::phase {

/// Points of a Gauss–Legendre rule on [−1,1].
struct GaussRule {
    static constexpr int points = 16;
    std::array<double, points> nodes;
    std::array<double, points> weights;
};

/// The 16-point rule, exact for polynomials of degree 31.
const GaussRule& gaussRule();

/// ∫ f over [begin,end] with one 16-point rule.
double integratePanel(double begin, double end, const std::function<double(double)>& f);

/// Ends of panels that divide the angles [begin,end] ⊂ [0,π] so that one 16-point rule suits each panel. Panels are no
/// shorter than `finest` (the width of a lobe at either pole), grow in proportion to the distance from the poles, and
/// are no longer than `longest`.
std::vector<double> anglePanels(double begin, double end, double finest, double longest);

/// 2π ∫ f(θ) P_l(cos θ) sin θ dθ over [begin,end] for l = 0..count−1, for an f with lobes no narrower than `finest`
/// [radians]. Runs on all threads; the result does not depend on their number.
std::vector<double> legendreMoments(const std::function<double(double)>& f, double begin, double end, double finest,
                                    int count);

}  // namespace lumulus::phase
