#include "light/fog_light/transport.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "light/fog_light/legendre.h"
#include "medium/quadrature.h"

namespace lumulus::fog_light {

namespace {

using std::numbers::pi;

constexpr auto streams = static_cast<std::size_t>(streamCount), degrees = static_cast<std::size_t>(momentCount);
static_assert(streamCount == phase::GaussRule::points);
/// Of what is left over.
constexpr double tolerance = 1e-6;

std::size_t at(std::size_t row, std::size_t stream) {
    return row * streams + stream;
}

}  // namespace

const Streams makeStreams() {
    Streams made;
    for (int i = 0; i < streamCount; ++i) {
        made.cosines.push_back(0.5 * (phase::gaussRule().nodes[static_cast<std::size_t>(i)] + 1.0));
        made.weights.push_back(0.5 * phase::gaussRule().weights[static_cast<std::size_t>(i)]);
    }
    return made;
}

SourceWeights sourceWeights(double depth) {
    if (depth < 1e-3) {
        const double last = depth * (0.5 - depth / 6.0);
        return {std::exp(-depth), -std::expm1(-depth) - last, last};
    }
    const double filled = -std::expm1(-depth), last = 1.0 - filled / depth;
    return {std::exp(-depth), filled - last, last};
}

double beamWeightUp(double depth, double beam, double light) {
    return -std::expm1(-depth * (1.0 / light + 1.0 / beam)) / (1.0 + light / beam);
}

double beamWeightDown(double depth, double beam, double light) {
    const double z = depth * (1.0 / light - 1.0 / beam), away = std::abs(z);
    const double mean = away < 1e-6 ? 1.0 - 0.5 * away : -std::expm1(-away) / away;
    return depth / light * mean * std::exp(-depth / std::max(z > 0.0 ? beam : light, 1e-30));
}

ModeTransport::ModeTransport(const Stack& stack, int mode, std::optional<double> albedo)
    : stack_(stack), mode_(mode), albedo_(albedo), streams_(makeStreams()) {
    legendre_.assign(degrees, Vector(streams));
    for (std::size_t j = 0; j < streams; ++j) {
        const Vector values = legendre(mode, momentCount, streams_.cosines[j]);
        for (std::size_t l = 0; l < degrees; ++l) legendre_[l][j] = values[l];
    }
    for (const double depth : stack.depth)
        for (const double cosine : streams_.cosines) {
            const SourceWeights weights = sourceWeights(depth / cosine);
            passes_.push_back(weights.passes);
            nearer_.push_back(weights.first);
            farther_.push_back(weights.last);
        }
}

/// Source of an interval's medium in light of these moments, by stream upwards and downwards.
void ModeTransport::addSource(std::size_t interval, const double* moments, double* up, double* down) const {
    double even[streams] = {}, odd[streams] = {};
    for (auto l = static_cast<std::size_t>(mode_); l < degrees; ++l) {
        const double factor = (2.0 * static_cast<double>(l) + 1.0) * stack_.moments[interval][l] * moments[l];
        double* to = (l + static_cast<std::size_t>(mode_)) % 2 == 0 ? even : odd;
        for (std::size_t j = 0; j < streams; ++j) to[j] += factor * legendre_[l][j];
    }
    for (std::size_t j = 0; j < streams; ++j) {
        up[j] = even[j] + odd[j];
        down[j] = even[j] - odd[j];
    }
}

/// [interval][lower, upper end][up, down][stream]
Vector ModeTransport::sourcesOf(const Vector& moments) const {
    Vector sources(stack_.intervals() * 4 * streams);
    for (std::size_t i = 0; i < stack_.intervals(); ++i)
        for (std::size_t end = 0; end < 2; ++end) {
            double* to = &sources[(4 * i + 2 * end) * streams];
            if (end == 0 && i > 0 && stack_.moments[i] == stack_.moments[i - 1])
                std::copy_n(to - 2 * streams, 2 * streams, to);
            else
                addSource(i, &moments[(i + end) * degrees], to, to + streams);
        }
    return sources;
}

/// [interval][up, down][stream], at the upper end
Vector ModeTransport::beamSources(const Beam& beam) const {
    Vector sources(stack_.intervals() * 2 * streams);
    const Vector values = legendre(mode_, momentCount, -beam.cosine);
    const double scale = (mode_ == 0 ? 1.0 : 2.0) * beam.irradiance / (4.0 * pi);
    for (std::size_t i = 0; i < stack_.intervals(); ++i) {
        Vector moments(degrees);
        const double reaching = scale * std::exp(-stack_.above[i + 1] / beam.cosine);
        for (std::size_t l = 0; l < degrees; ++l) moments[l] = values[l] * reaching;
        addSource(i, moments.data(), &sources[2 * i * streams], &sources[(2 * i + 1) * streams]);
    }
    return sources;
}

Radiance ModeTransport::sweep(const Vector& sources, const Vector& beams, const Beam& beam,
                              const Incoming& incoming) const {
    const std::size_t count = stack_.intervals();
    Radiance made{Vector((count + 1) * streams), Vector((count + 1) * streams)};
    std::ranges::copy(incoming.above, &made.down[at(count, 0)]);
    std::ranges::copy(incoming.below, made.up.data());
    for (std::size_t i = count; i-- > 0;)
        for (std::size_t j = 0; j < streams; ++j) {
            const double* low = &sources[4 * i * streams];
            double light = passes_[at(i, j)] * made.down[at(i + 1, j)] + nearer_[at(i, j)] * low[3 * streams + j] +
                           farther_[at(i, j)] * low[streams + j];
            if (!beams.empty())
                light += beams[at(2 * i + 1, j)] * beamWeightDown(stack_.depth[i], beam.cosine, streams_.cosines[j]);
            made.down[at(i, j)] = light;
        }
    if (albedo_ && mode_ == 0) {
        double falling = irradianceBelow(made);
        if (!beams.empty()) falling += beam.irradiance * beam.cosine * std::exp(-stack_.above[0] / beam.cosine);
        for (std::size_t j = 0; j < streams; ++j) made.up[j] += *albedo_ / pi * falling;
    }
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t j = 0; j < streams; ++j) {
            const double* low = &sources[4 * i * streams];
            double light = passes_[at(i, j)] * made.up[at(i, j)] + nearer_[at(i, j)] * low[j] +
                           farther_[at(i, j)] * low[2 * streams + j];
            if (!beams.empty())
                light += beams[at(2 * i, j)] * beamWeightUp(stack_.depth[i], beam.cosine, streams_.cosines[j]);
            made.up[at(i + 1, j)] = light;
        }
    return made;
}

Vector ModeTransport::momentsOf(const Radiance& radiance) const {
    const std::size_t levels = stack_.intervals() + 1;
    Vector moments(levels * degrees, 0.0);
    for (std::size_t k = 0; k < levels; ++k) {
        double even[streams], odd[streams];
        for (std::size_t j = 0; j < streams; ++j) {
            const double up = radiance.up[at(k, j)], down = radiance.down[at(k, j)];
            even[j] = 0.5 * streams_.weights[j] * (up + down);
            odd[j] = 0.5 * streams_.weights[j] * (up - down);
        }
        for (auto l = static_cast<std::size_t>(mode_); l < degrees; ++l) {
            const double* from = (l + static_cast<std::size_t>(mode_)) % 2 == 0 ? even : odd;
            double sum = 0.0;
            for (std::size_t j = 0; j < streams; ++j) sum += from[j] * legendre_[l][j];
            moments[k * degrees + l] = sum;
        }
    }
    return moments;
}

double ModeTransport::irradianceBelow(const Radiance& radiance) const {
    double sum = 0.0;
    for (std::size_t j = 0; j < streams; ++j)
        sum += 2.0 * pi * streams_.weights[j] * streams_.cosines[j] * radiance.down[j];
    return sum;
}

Radiance ModeTransport::radiance(const Vector& moments, const Beam& beam, const Incoming& incoming) const {
    Vector sources = sourcesOf(moments);
    if (mode_ == 0)
        for (std::size_t i = 0; i < stack_.intervals(); ++i)
            for (std::size_t j = 0; j < 4 * streams; ++j) sources[4 * i * streams + j] += stack_.emitted[i];
    return sweep(sources, beamSources(beam), beam, incoming);
}

Vector ModeTransport::solve(const Beam& beam, const Incoming& incoming) const {
    const Vector nothing((stack_.intervals() + 1) * degrees, 0.0);
    const Incoming dark{Vector(streams, 0.0), Vector(streams, 0.0)};
    const Vector first = momentsOf(radiance(nothing, beam, incoming));
    return solveFixedPoint([&](const Vector& moments) { return momentsOf(sweep(sourcesOf(moments), {}, beam, dark)); },
                           first, tolerance);
}

}  // namespace lumulus::fog_light
