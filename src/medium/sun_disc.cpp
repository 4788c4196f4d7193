#include "medium/sun_disc.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "medium/quadrature.h"

namespace lumulus::phase {

namespace {

using std::numbers::pi;

/// Half of the azimuths, as an angle in [0,π], at which the circle of radius psi about the middle of the lobe lies
/// in the disc (spherical law of haversines).
double halfArc(double psi, double theta, double radius) {
    const double across = std::sin(psi) * std::sin(theta);
    const double inside = std::sin(0.5 * (radius - psi + theta)) * std::sin(0.5 * (radius + psi - theta));
    if (across <= 0.0) {
        return inside > 0.0 ? pi : 0.0;
    }
    return 2.0 * std::asin(std::sqrt(std::clamp(inside / across, 0.0, 1.0)));
}

}  // namespace

std::vector<double> discMoments(double radius, int count) {
    std::vector<double> moments(static_cast<std::size_t>(count), 1.0);
    if (radius <= 0.0) {
        return moments;
    }
    const double s = std::sin(0.5 * radius);
    const double oneMinusCos = 2.0 * s * s;
    const double cosine = std::cos(radius);
    double before = 1.0;
    double value = cosine;
    for (std::size_t i = 1; i < moments.size(); ++i) {
        const double l = static_cast<double>(i);
        const double next = ((2.0 * l + 1.0) * cosine * value - l * before) / (l + 1.0);
        moments[i] = (before - next) / ((2.0 * l + 1.0) * oneMinusCos);
        before = value;
        value = next;
    }
    return moments;
}

double averageOverDisc(const PhaseFunction& phase, double theta, double radius) {
    if (radius <= 0.0) {
        return phase.evaluateAngle(theta);
    }
    const double finest = 0.25 * phase.lobeWidth();
    double sum = 0.0;
    // circles about the lobe, or about its opposite direction, that lie wholly in the disc
    const auto addWhole = [&](double begin, double end) {
        const std::vector<double> ends = anglePanels(begin, end, finest, radius);
        for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
            sum += integratePanel(ends[i], ends[i + 1],
                                  [&](double psi) { return 2.0 * pi * phase.evaluateAngle(psi) * std::sin(psi); });
        }
    };
    addWhole(0.0, std::max(radius - theta, 0.0));
    addWhole(std::min(2.0 * pi - radius - theta, pi), pi);
    // circles that cross its edge; ψ = nearest + half (1 − cos t) takes the square roots at both ends away, and panels
    // that halve towards the near end follow a lobe much narrower than the disc
    const double nearest = std::abs(theta - radius);
    const double farthest = std::min(theta + radius, 2.0 * pi - theta - radius);
    const double half = 0.5 * (farthest - nearest);
    double begin = 0.0;
    constexpr int panels = 14;
    for (int i = 0; i < panels; ++i) {
        const double end = pi * std::ldexp(1.0, i + 1 - panels);
        sum += integratePanel(begin, end, [&](double t) {
            const double q = std::sin(0.5 * t);
            const double psi = nearest + 2.0 * half * q * q;
            const double arc = 2.0 * halfArc(psi, theta, radius);
            return arc * phase.evaluateAngle(psi) * std::sin(psi) * half * std::sin(t);
        });
        begin = end;
    }
    const double s = std::sin(0.5 * radius);
    return sum / (4.0 * pi * s * s);
}

}  // namespace lumulus::phase
