#include "medium/single_scattering.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "medium/axes.h"
#include "medium/sun_disc.h"
#include "shared/phase_table.h"

namespace lumulus::phase {

namespace {

using std::numbers::pi;

constexpr std::size_t angles = shared::singleScatterAngleCount;
constexpr std::size_t taus = shared::singleScatterTauCount;
constexpr int fewestTerms = 256;
constexpr int mostTerms = 1 << 14;
constexpr std::size_t block = 8;        // terms summed in one pass
constexpr std::size_t rowsPerTask = 4;  // optical depths summed together

/// P_l at all angles of the axis, l slowest.
std::vector<double> legendreTable(std::size_t terms, double angleScale) {
    std::vector<double> table(std::max<std::size_t>(terms, 2) * angles);
    std::vector<double> cosine(angles);
    for (std::size_t i = 0; i < angles; ++i) {
        cosine[i] = std::cos(axisToAngle(static_cast<double>(i) / static_cast<double>(angles - 1), angleScale));
        table[i] = 1.0;
        table[angles + i] = cosine[i];
    }
    for (std::size_t l = 1; l + 1 < terms; ++l) {
        const double order = static_cast<double>(l);
        const double a = (2.0 * order + 1.0) / (order + 1.0);
        const double b = order / (order + 1.0);
        const double* before = &table[(l - 1) * angles];
        const double* value = &table[l * angles];
        double* next = &table[(l + 1) * angles];
        for (std::size_t i = 0; i < angles; ++i) {
            next[i] = a * cosine[i] * value[i] - b * before[i];
        }
    }
    return table;
}

/// (e^(ω a τ) − 1) e^(−ω f τ) without overflow and without cancellation.
double growth(double exponent, double largest) {
    return exponent < 1.0 ? std::exp(-largest) * std::expm1(exponent)
                          : std::exp(exponent - largest) - std::exp(-largest);
}

/// Weights of the Legendre polynomials for one optical depth and one albedo; a multiple of `block` of them.
struct Weights {
    std::vector<double> h;
    std::vector<double> k;
};

/// Makes the weights and ends them after the last that matters: each dropped one is below 3e−9 of the sum of all, and
/// their signs alternate.
Weights makeWeights(const SingleScatteringSeries& series, double scatteringDepth, double forward) {
    const std::size_t terms = series.inside.size();
    Weights weights{std::vector<double>(terms), std::vector<double>(terms)};
    double all = 0.0;
    for (std::size_t l = 0; l < terms; ++l) {
        const double common = (2.0 * static_cast<double>(l) + 1.0) / (4.0 * pi) * series.disc[l] *
                              growth(scatteringDepth * series.inside[l], scatteringDepth * forward);
        weights.h[l] = common * series.inside[l];
        weights.k[l] = common * series.outside[l];
        all += std::abs(weights.h[l]) + std::abs(weights.k[l]);
    }
    std::size_t last = terms;
    while (last > block && std::max(std::abs(weights.h[last - 1]), std::abs(weights.k[last - 1])) <= 3e-9 * all) {
        --last;
    }
    last = (last + block - 1) / block * block;
    weights.h.resize(last);
    weights.k.resize(last);
    return weights;
}

/// Adds Σ weight_l P_l to the sums at all angles, for `block` terms, in one pass that reads and writes the sums once.
void addBlock(const double* weights, const double* legendre, double* sums) {
    static_assert(block == 8);
    for (std::size_t i = 0; i < angles; ++i) {
        const double* p = legendre + i;
        const double first =
            weights[0] * p[0] + weights[1] * p[angles] + weights[2] * p[2 * angles] + weights[3] * p[3 * angles];
        const double second = weights[4] * p[4 * angles] + weights[5] * p[5 * angles] + weights[6] * p[6 * angles] +
                              weights[7] * p[7 * angles];
        sums[i] += first + second;
    }
}

/// The two sums of one optical depth and one albedo at all angles.
struct Sums {
    std::vector<double> h = std::vector<double>(angles, 0.0);
    std::vector<double> k = std::vector<double>(angles, 0.0);
};

std::vector<Sums> sumSeries(const std::vector<Weights>& weights, const std::vector<double>& legendre) {
    std::vector<Sums> sums(weights.size());
    std::size_t last = 0;
    for (const Weights& w : weights) {
        last = std::max(last, w.h.size());
    }
    // blocks in the outer loop, so that the polynomials are read from memory once
    for (std::size_t l = 0; l < last; l += block) {
        for (std::size_t i = 0; i < weights.size(); ++i) {
            if (l < weights[i].h.size()) {
                addBlock(&weights[i].h[l], &legendre[l * angles], sums[i].h.data());
                addBlock(&weights[i].k[l], &legendre[l * angles], sums[i].k.data());
            }
        }
    }
    return sums;
}

}  // namespace

SingleScatteringSeries makeSingleScatteringSeries(const PhaseFunction& phase, double thetaCut, double discRadius) {
    SingleScatteringSeries series;
    for (int terms = fewestTerms;; terms *= 2) {
        series.inside = phase.forwardMoments(thetaCut, terms);
        series.outside = phase.moments(terms);
        series.disc = discMoments(discRadius, terms);
        double all = 0.0;
        double lastOctave = 0.0;
        for (std::size_t l = 0; l < series.inside.size(); ++l) {
            series.outside[l] -= series.inside[l];
            // first order in τ, where the series converges slowest
            const double term = (2.0 * static_cast<double>(l) + 1.0) * std::abs(series.disc[l] * series.inside[l]) *
                                (std::abs(series.inside[l]) + std::abs(series.outside[l]));
            all += term;
            lastOctave += 2 * l >= series.inside.size() ? term : 0.0;
        }
        // terms fall as 1/l² or faster, so the rest is at most as large as the last octave
        if (lastOctave <= 1e-4 * all || terms >= mostTerms) {
            return series;
        }
    }
}

SingleScatteringTables makeSingleScatteringTables(std::span<const SingleScatteringSeries> series,
                                                  const glm::dvec3& albedo, double forward, double angleScale,
                                                  double tauMaximum) {
    std::size_t terms = 0;
    for (const SingleScatteringSeries& one : series) terms = std::max(terms, one.inside.size());
    const std::vector<double> legendre = legendreTable(terms, angleScale);
    const bool grey = series.size() == 1 && albedo.r == albedo.g && albedo.g == albedo.b;
    const std::size_t channels = grey ? 1 : 3;
    SingleScatteringTables tables{std::vector<float>(3 * angles * taus), std::vector<float>(3 * angles * taus)};
    static_assert(taus % rowsPerTask == 0);
    tbb::parallel_for(std::size_t{0}, taus / rowsPerTask, [&](std::size_t task) {
        std::vector<Weights> weights;
        for (std::size_t i = 0; i < rowsPerTask * channels; ++i) {
            const double row = static_cast<double>(task * rowsPerTask + i / channels);
            const double tau = axisToTau(row / static_cast<double>(taus - 1), tauMaximum);
            const std::size_t channel = i % channels;
            weights.push_back(makeWeights(series[series.size() == 1 ? 0 : channel],
                                          albedo[static_cast<glm::length_t>(channel)] * tau, forward));
        }
        const std::vector<Sums> sums = sumSeries(weights, legendre);
        for (std::size_t entry = 0; entry < rowsPerTask * 3; ++entry) {
            const std::size_t channel = entry % 3;
            const Sums& from = sums[entry / 3 * channels + (grey ? 0 : channel)];
            const auto row = static_cast<int>(task * rowsPerTask + entry / 3);
            for (std::size_t i = 0; i < angles; ++i) {
                const auto slot =
                    static_cast<std::size_t>(shared::singleScatterIndex(static_cast<int>(i), row)) + channel;
                tables.h[slot] = static_cast<float>(from.h[i]);
                tables.k[slot] = static_cast<float>(from.k[i]);
            }
        }
    });
    return tables;
}

}  // namespace lumulus::phase
