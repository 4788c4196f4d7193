#include "light/fog_light/rows.h"

#include <cmath>
#include <numbers>

#include "light/fog_light/legendre.h"
#include "shared/fog_light.h"

namespace lumulus::fog_light {

namespace {

constexpr auto rows = static_cast<std::size_t>(shared::FOG_ROWS), degrees = static_cast<std::size_t>(momentCount);
/// Rows at the horizon stand for those just beside it.
constexpr double leastCosine = 1e-7;

/// Source of an interval in light of these moments, by row upwards in `above` (light that travels down) and downwards.
struct RowSource {
    Vector lookingUp, lookingDown;
};

RowSource sourceOf(const Stack& stack, std::size_t interval, int mode, const double* moments,
                   const std::vector<Vector>& polynomials) {
    Vector even(rows, 0.0), odd(rows, 0.0);
    for (auto l = static_cast<std::size_t>(mode); l < degrees; ++l) {
        const double factor = (2.0 * static_cast<double>(l) + 1.0) * stack.moments[interval][l] * moments[l];
        Vector& to = (l + static_cast<std::size_t>(mode)) % 2 == 0 ? even : odd;
        for (std::size_t r = 0; r < rows; ++r) to[r] += factor * polynomials[l][r];
    }
    const double emitted = mode == 0 ? stack.emitted[interval] : 0.0;
    RowSource source{Vector(rows), Vector(rows)};
    for (std::size_t r = 0; r < rows; ++r) {
        source.lookingUp[r] = even[r] - odd[r] + emitted;
        source.lookingDown[r] = even[r] + odd[r] + emitted;
    }
    return source;
}

/// Divides light that is seen along a row through the optical depth `depth` by the share of it that comes out of the
/// fog; `limit` where there is none.
double overOpacity(double light, double depth, double limit) {
    return depth > 1e-12 ? light / -std::expm1(-depth) : limit;
}

}  // namespace

Vector rowCosines() {
    Vector cosines;
    for (int row = 0; row < shared::FOG_ROWS; ++row) {
        const double angle = static_cast<double>(shared::FOG_FINEST_ANGLE) *
                             std::sinh(static_cast<double>(shared::FOG_ROW_SCALE) * row / (shared::FOG_ROWS - 1.0));
        cosines.push_back(std::max(leastCosine, std::sin(std::min(angle, 0.5 * std::numbers::pi))));
    }
    return cosines;
}

Vector columnAzimuths() {
    Vector azimuths;
    for (int column = 0; column < shared::FOG_COLUMNS; ++column) {
        const double place = column / (shared::FOG_COLUMNS - 1.0);
        azimuths.push_back(std::numbers::pi * place * place);
    }
    return azimuths;
}

Vector seenAlongRows(const Stack& stack, int mode, const Vector& moments) {
    const Vector cosines = rowCosines();
    std::vector<Vector> polynomials(degrees, Vector(rows));
    for (std::size_t r = 0; r < rows; ++r) {
        const Vector values = legendre(mode, momentCount, cosines[r]);
        for (std::size_t l = 0; l < degrees; ++l) polynomials[l][r] = values[l];
    }
    const std::size_t count = stack.intervals();
    Vector seen((count + 1) * 2 * rows, 0.0);
    std::vector<std::pair<RowSource, RowSource>> sources;  // at the lower and at the upper end
    for (std::size_t i = 0; i < count; ++i) {
        const bool same = i > 0 && stack.moments[i] == stack.moments[i - 1] && stack.emitted[i] == stack.emitted[i - 1];
        sources.emplace_back(
            same ? sources[i - 1].second : sourceOf(stack, i, mode, &moments[i * degrees], polynomials),
            sourceOf(stack, i, mode, &moments[(i + 1) * degrees], polynomials));
    }
    Vector light(count + 1);
    for (std::size_t r = 0; r < rows; ++r) {
        seen[2 * count * rows + r] = sources.back().second.lookingUp[r];
        seen[rows + r] = sources.front().first.lookingDown[r];
        light.assign(count + 1, 0.0);
        for (std::size_t i = count; i-- > 0;) {
            const SourceWeights w = sourceWeights(stack.depth[i] / cosines[r]);
            light[i] = w.passes * light[i + 1] + w.first * sources[i].second.lookingUp[r] +
                       w.last * sources[i].first.lookingUp[r];
            seen[2 * i * rows + r] = overOpacity(light[i], stack.above[i] / cosines[r], sources[i].first.lookingUp[r]);
        }
        light.assign(count + 1, 0.0);
        for (std::size_t i = 0; i < count; ++i) {
            const SourceWeights w = sourceWeights(stack.depth[i] / cosines[r]);
            light[i + 1] = w.passes * light[i] + w.first * sources[i].first.lookingDown[r] +
                           w.last * sources[i].second.lookingDown[r];
            seen[(2 * (i + 1) + 1) * rows + r] = overOpacity(
                light[i + 1], (stack.above[0] - stack.above[i + 1]) / cosines[r], sources[i].second.lookingDown[r]);
        }
    }
    return seen;
}

Vector onceAlongRows(const Stack& stack, const Vector& scattered, double beamCosine) {
    const Vector cosines = rowCosines();
    const std::size_t count = stack.intervals();
    Vector seen((count + 1) * 2 * rows, 0.0);
    Vector sources(count);
    for (std::size_t i = 0; i < count; ++i) sources[i] = scattered[i] * std::exp(-stack.above[i + 1] / beamCosine);
    Vector light(count + 1);
    for (std::size_t r = 0; r < rows; ++r) {
        seen[2 * count * rows + r] = sources.back();
        seen[rows + r] = scattered.front() * std::exp(-stack.above[0] / beamCosine);
        light.assign(count + 1, 0.0);
        for (std::size_t i = count; i-- > 0;) {
            light[i] = std::exp(-stack.depth[i] / cosines[r]) * light[i + 1] +
                       sources[i] * beamWeightDown(stack.depth[i], beamCosine, cosines[r]);
            seen[2 * i * rows + r] = overOpacity(light[i], stack.above[i] / cosines[r], sources[i]);
        }
        light.assign(count + 1, 0.0);
        for (std::size_t i = 0; i < count; ++i) {
            light[i + 1] = std::exp(-stack.depth[i] / cosines[r]) * light[i] +
                           sources[i] * beamWeightUp(stack.depth[i], beamCosine, cosines[r]);
            seen[(2 * (i + 1) + 1) * rows + r] =
                overOpacity(light[i + 1], (stack.above[0] - stack.above[i + 1]) / cosines[r], sources[i]);
        }
    }
    return seen;
}

}  // namespace lumulus::fog_light
