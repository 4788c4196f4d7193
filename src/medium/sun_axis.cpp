#include "medium/sun_axis.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "medium/axes.h"
#include "medium/sun_disc.h"
#include "shared/phase_table.h"
#include "shared/sun_axis.h"

namespace lumulus::phase {

namespace {

using std::numbers::pi;

/// A phase function that falls to half of its backward value or less within this angle has a peak there. At
/// Henyey–Greenstein's g = −0.5, which four bands hold, it falls by a factor of 1.9.
constexpr double nearBackward = pi / 6.0, peaked = 2.0;

double radiusOf(int ring) {
    return 2.0 * std::asin(0.5 * static_cast<double>(shared::axisRingEdge(ring)));
}

/// Solid angle of a disc over 2π.
double solidAngle(double radius) {
    const double s = std::sin(0.5 * radius);
    return 2.0 * s * s;
}

}  // namespace

bool hasBackwardPeak(const PhaseFunction& phase) {
    // a glory of droplets is too faint for light to go to and fro
    return phase.table() == nullptr && phase.evaluateAngle(pi) > peaked * phase.evaluateAngle(pi - nearBackward);
}

std::vector<float> makeAxisTable(const PhaseFunction& mirrored, double angleScale, int bands) {
    constexpr auto angles = static_cast<std::size_t>(shared::singleScatterAngleCount);
    constexpr auto rings = static_cast<std::size_t>(shared::AXIS_RINGS);
    // by the mirrored angle the moments are those of the mirrored p, and the ring's own
    const std::vector<double> moments = mirrored.moments(bands);
    std::vector<std::vector<double>> discs;
    for (int ring = 0; ring <= shared::AXIS_RINGS; ++ring) discs.push_back(discMoments(radiusOf(ring), bands));
    std::vector<float> table(rings * angles);
    tbb::parallel_for(std::size_t{0}, angles, [&](std::size_t i) {
        const double theta = pi - axisToAngle(static_cast<double>(i) / static_cast<double>(angles - 1), angleScale);
        double within = 0.0, area = 0.0;  // of the disc inside the ring
        for (std::size_t ring = 0; ring < rings; ++ring) {
            const double radius = radiusOf(static_cast<int>(ring) + 1), disc = solidAngle(radius);
            double whole = averageOverDisc(mirrored, theta, radius);
            for (int l = 0; l < bands; ++l)
                whole -= (2.0 * l + 1.0) / (4.0 * pi) * moments[static_cast<std::size_t>(l)] *
                         discs[ring + 1][static_cast<std::size_t>(l)] *
                         std::legendre(static_cast<unsigned>(l), std::cos(theta));
            whole *= disc;
            table[ring * angles + i] = static_cast<float>((whole - within) / (disc - area));
            within = whole;
            area = disc;
        }
    });
    return table;
}

}  // namespace lumulus::phase
