#include "medium/quadrature.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cassert>
#include <cmath>
#include <numbers>

namespace lumulus::phase {

namespace {

using std::numbers::pi;
constexpr int lanes = GaussRule::points;

GaussRule makeGaussRule() {
    using Known = boost::math::quadrature::gauss<double, lanes>;
    GaussRule rule{};
    constexpr std::size_t half = lanes / 2;
    for (std::size_t i = 0; i < half; ++i) {
        // the library lists the positive nodes, from the middle on
        const std::size_t before = half - 1 - i, behind = half + i;
        rule.nodes[before] = Known::abscissa()[i];
        rule.nodes[behind] = -Known::abscissa()[i];
        rule.weights[before] = rule.weights[behind] = Known::weights()[i];
    }
    return rule;
}

/// Adds the moments of one panel to `sums`.
void addPanel(const std::function<double(double)>& f, double begin, double end, std::vector<double>& sums) {
    const GaussRule& rule = gaussRule();
    const double half = 0.5 * (end - begin);
    std::array<double, lanes> cosine{};
    std::array<double, lanes> before{};
    std::array<double, lanes> value{};  // weight times P_l: the recurrence is linear
    for (std::size_t i = 0; i < lanes; ++i) {
        const double theta = 0.5 * (begin + end) + half * rule.nodes[i];
        cosine[i] = std::cos(theta);
        value[i] = 2.0 * pi * std::sin(theta) * half * rule.weights[i] * f(theta);
    }
    for (std::size_t l = 0; l < sums.size(); ++l) {
        const double order = static_cast<double>(l);
        const double a = (2.0 * order + 1.0) / (order + 1.0);
        const double b = order / (order + 1.0);
        double sum = 0.0;
        for (std::size_t i = 0; i < lanes; ++i) {
            sum += value[i];
            const double next = a * cosine[i] * value[i] - b * before[i];
            before[i] = value[i];
            value[i] = next;
        }
        sums[l] += sum;
    }
}

}  // namespace

const GaussRule& gaussRule() {
    static const GaussRule rule = makeGaussRule();
    return rule;
}

double integratePanel(double begin, double end, const std::function<double(double)>& f) {
    const GaussRule& rule = gaussRule();
    const double half = 0.5 * (end - begin);
    double sum = 0.0;
    for (std::size_t i = 0; i < lanes; ++i) {
        sum += rule.weights[i] * f(0.5 * (begin + end) + half * rule.nodes[i]);
    }
    return half * sum;
}

std::vector<double> anglePanels(double begin, double end, double finest, double longest) {
    assert(begin >= 0.0 && begin <= end && end <= pi + 1e-12 && finest > 0.0 && longest > 0.0);
    std::vector<double> ends{begin};
    for (double at = begin; at < end;) {
        const double graded = std::min(std::max(finest, 0.5 * at), std::max(finest, (pi - at) / 3.0));
        const double width = std::min(graded, longest);
        // the last panel takes a short remainder too
        at = end - at < 1.25 * width ? end : at + width;
        ends.push_back(at);
    }
    return ends;
}

std::vector<double> legendreMoments(const std::function<double(double)>& f, double begin, double end, double finest,
                                    int count) {
    assert(count >= 1);
    // P_l has the wavelength 2π/l; 16 points do two of them to rounding
    const std::vector<double> ends = anglePanels(begin, end, finest, std::min(0.25, 4.0 * pi / count));
    constexpr std::size_t panelsPerTask = 16;
    const std::size_t panels = ends.size() - 1;
    const std::size_t tasks = (panels + panelsPerTask - 1) / panelsPerTask;
    std::vector<std::vector<double>> partial(tasks, std::vector<double>(static_cast<std::size_t>(count), 0.0));
    tbb::parallel_for(std::size_t{0}, tasks, [&](std::size_t task) {
        for (std::size_t i = task * panelsPerTask; i < std::min(panels, (task + 1) * panelsPerTask); ++i) {
            addPanel(f, ends[i], ends[i + 1], partial[task]);
        }
    });
    std::vector<double> sums(static_cast<std::size_t>(count), 0.0);
    for (const std::vector<double>& part : partial) {
        for (std::size_t l = 0; l < sums.size(); ++l) {
            sums[l] += part[l];
        }
    }
    return sums;
}

}  // namespace lumulus::phase
