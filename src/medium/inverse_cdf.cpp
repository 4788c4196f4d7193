#include "medium/inverse_cdf.h"

#include <cmath>
#include <numbers>

#include "medium/quadrature.h"
#include "shared/phase_table.h"

namespace lumulus::phase {

namespace {

using std::numbers::pi;

/// The angle in [begin,end] from which `mass` of the density remains up to `end`: Newton, kept in a bracket.
template <typename Density>
double solve(const Density& density, double begin, double end, double mass) {
    double low = begin;
    double high = end;
    double theta = 0.5 * (begin + end);
    for (int iteration = 0; iteration < 60; ++iteration) {
        const double excess = integratePanel(theta, end, density) - mass;
        (excess > 0.0 ? low : high) = theta;
        const double slope = density(theta);
        double next = slope > 0.0 ? theta + excess / slope : low - 1.0;
        if (!(next > low && next < high)) {
            next = 0.5 * (low + high);
        }
        if (std::abs(next - theta) < 1e-12 * end) {
            return next;
        }
        theta = next;
    }
    return theta;
}

}  // namespace

std::vector<float> makeInverseCdf(const PhaseFunction& phase, double thetaCut) {
    const auto density = [&phase](double theta) { return 2.0 * pi * std::sin(theta) * phase.evaluateAngle(theta); };
    const std::vector<double> ends = phase.panels(thetaCut, pi);
    // mass between the begin of a panel and π
    std::vector<double> beyond(ends.size(), 0.0);
    for (std::size_t i = ends.size() - 1; i-- > 0;) {
        beyond[i] = beyond[i + 1] + integratePanel(ends[i], ends[i + 1], density);
    }
    std::vector<float> table(static_cast<std::size_t>(shared::inverseCdfCells) + 1);
    std::size_t panel = ends.size() - 2;
    for (int i = 0; i <= shared::inverseCdfCells; ++i) {
        const double mass = static_cast<double>(shared::inverseCdfNode(i)) * beyond.front();
        while (panel > 0 && beyond[panel] < mass) {
            --panel;
        }
        double theta = pi;
        if (i == shared::inverseCdfCells) {
            theta = thetaCut;
        } else if (i > 0) {
            theta = solve(density, ends[panel], ends[panel + 1], mass - beyond[panel + 1]);
        }
        const double s = std::sin(0.5 * theta);
        table[static_cast<std::size_t>(i)] = static_cast<float>(2.0 * s * s);
    }
    return table;
}

}  // namespace lumulus::phase
