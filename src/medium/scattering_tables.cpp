#include "medium/scattering_tables.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <span>

#include "medium/axes.h"
#include "medium/inverse_cdf.h"
#include "medium/phase_function.h"
#include "medium/single_scattering.h"
#include "medium/sun_axis.h"
#include "medium/sun_disc.h"
#include "shared/phase_table.h"

namespace lumulus::phase {

namespace {

constexpr double leastPhase = 1e-12;  // of a table that has zeros: its logarithm is finite

/// Of one phase function, or of those of red, green and blue.
std::vector<float> makePhaseTable(std::span<const PhaseFunction> channels, double angleScale, double discRadius) {
    constexpr auto size = static_cast<std::size_t>(shared::phaseTableSize);
    std::vector<float> table(size * channels.size());
    tbb::parallel_for(std::size_t{0}, table.size(), [&](std::size_t i) {
        const auto entry = static_cast<double>(i / channels.size());
        const double theta = axisToAngle(entry / static_cast<double>(size - 1), angleScale);
        const double p = averageOverDisc(channels[i % channels.size()], theta, discRadius);
        table[i] = static_cast<float>(std::log(std::max(p, leastPhase)));
    });
    return table;
}

void addSingleScattering(ScatteringTables& tables, std::span<const PhaseFunction> channels, double forward, double cut,
                         const glm::dvec3& albedo, double discRadius) {
    std::vector<SingleScatteringSeries> series;
    for (const PhaseFunction& phase : channels) series.push_back(makeSingleScatteringSeries(phase, cut, discRadius));
    const glm::dvec3 extinctionScale = 1.0 - albedo * forward;
    // e^−20 of the light is left there; a nearly conservative forward lobe lasts longer than any cloud is deep
    const double slowest = std::min({extinctionScale.r, extinctionScale.g, extinctionScale.b});
    const double tauMaximum = std::min(20.0 / slowest, 1e5);
    SingleScatteringTables forwardCut =
        makeSingleScatteringTables(series, albedo, forward, static_cast<double>(tables.angleScale), tauMaximum);
    tables.singleScatterH = std::move(forwardCut.h);
    tables.singleScatterK = std::move(forwardCut.k);
    tables.tauMaximum = static_cast<float>(tauMaximum);
    tables.extinctionScale = glm::vec3(extinctionScale);
}

/// Bands of a collector that are used where there are rings. A backward peak hands all bands on, noise included, and
/// noise below zero is cut off: more bands make pictures too bright (docs/experiments/backward-peak.md).
constexpr int bandsBesideRings = 3;

void addAxisTable(ScatteringTables& tables, const scene::Phase& phase, int bands) {
    scene::Phase mirrored = phase;
    mirrored.g = -phase.g;  // only models with a g have such a peak
    const int used = std::min(bands, bandsBesideRings);
    tables.axisTable = makeAxisTable(PhaseFunction(mirrored), static_cast<double>(tables.angleScale), used);
    for (std::size_t l = static_cast<std::size_t>(used); l < tables.bandMoments.size(); ++l)
        tables.bandMoments[l] = 0.0F;
}

}  // namespace

ScatteringTables makeScatteringTables(const scene::Phase& phase, double cutRadians, const glm::dvec3& albedo, int bands,
                                      double sunAngularDiameterRadians) {
    assert(cutRadians >= 0.0 && cutRadians < std::numbers::pi && bands >= 1 && sunAngularDiameterRadians >= 0.0);
    PhaseColours colours = phaseColours(phase);
    const PhaseFunction& function = colours.mean;
    const double discRadius = 0.5 * sunAngularDiameterRadians;
    const std::vector<double> moments = function.moments(std::max(bands, 2));
    const std::vector<double> forward = function.forwardMoments(cutRadians, bands);

    ScatteringTables tables;
    tables.forwardFraction = static_cast<float>(forward[0]);
    tables.scatterFraction = static_cast<float>(1.0 - forward[0]);
    for (std::size_t l = 0; l < forward.size(); ++l) {
        tables.bandMoments.push_back(static_cast<float>((moments[l] - forward[l]) / (1.0 - forward[0])));
    }
    tables.analyticHg = phase.model == scene::PhaseModel::henyeyGreenstein;
    tables.g = static_cast<float>(tables.analyticHg ? phase.g : moments[1]);
    if (!tables.analyticHg) {
        tables.inverseCdf = makeInverseCdf(function, cutRadians);
    }
    tables.angleScale = static_cast<float>(function.lobeWidth());
    std::vector<PhaseFunction>& channels = colours.channels;
    tables.coloured = !channels.empty();
    if (channels.empty()) channels.push_back(function);
    tables.phaseTable = makePhaseTable(channels, static_cast<double>(tables.angleScale), discRadius);
    if (hasBackwardPeak(function)) addAxisTable(tables, phase, bands);
    if (cutRadians > 0.0) {
        addSingleScattering(tables, channels, forward[0], cutRadians, albedo, discRadius);
    }
    return tables;
}

}  // namespace lumulus::phase
