#include "medium/tabulated_phase.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

namespace lumulus::phase {
namespace {

using std::numbers::pi;

constexpr std::size_t parts = 4096;  // of [0,π], for looking up cells

/// Three Gauss points of a cell: values are linear there, and Legendre polynomials of the orders that matter smooth.
constexpr std::array nodes{-0.7745966692414834, 0.0, 0.7745966692414834};
constexpr std::array weights{5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0};

/// A point of the quadrature with all its factors but the polynomial.
struct Point {
    double cosine, weight;
};

}  // namespace

TabulatedPhase::TabulatedPhase(std::vector<double> angles, std::vector<double> values)
    : angles_(std::move(angles)), values_(std::move(values)), first_(parts) {
    assert(angles_.size() >= 2 && angles_.size() == values_.size());
    angles_.front() = 0.0;
    angles_.back() = pi;
    std::size_t cell = 0;
    for (std::size_t part = 0; part < parts; ++part) {
        const double theta = pi * static_cast<double>(part) / static_cast<double>(parts);
        while (cell + 2 < angles_.size() && angles_[cell + 1] <= theta) ++cell;
        first_[part] = cell;
    }
    factor_ = 1.0 / moments(0.0, pi, 1).front();
    for (double& value : values_) value *= factor_;
}

std::size_t TabulatedPhase::cellOf(double theta) const {
    const auto part = static_cast<std::size_t>(std::clamp(theta / pi, 0.0, 1.0) * static_cast<double>(parts));
    std::size_t cell = first_[std::min(part, parts - 1)];
    while (cell + 2 < angles_.size() && angles_[cell + 1] <= theta) ++cell;
    return cell;
}

double TabulatedPhase::evaluate(double theta) const {
    const std::size_t cell = cellOf(theta);
    const double share = std::clamp((theta - angles_[cell]) / (angles_[cell + 1] - angles_[cell]), 0.0, 1.0);
    return values_[cell] + share * (values_[cell + 1] - values_[cell]);
}

std::vector<double> TabulatedPhase::moments(double begin, double end, int count) const {
    assert(count >= 1);
    std::vector<Point> points;
    // cells are divided so that P_l is smooth within each part
    const double longest = std::min(0.05, 1.5 / count);
    for (std::size_t cell = 0; cell + 1 < angles_.size(); ++cell) {
        const double low = std::max(begin, angles_[cell]), high = std::min(end, angles_[cell + 1]);
        if (!(high > low)) continue;
        const int divisions = static_cast<int>(std::ceil((high - low) / longest));
        const double half = 0.5 * (high - low) / divisions;
        for (int i = 0; i < divisions; ++i)
            for (std::size_t k = 0; k < nodes.size(); ++k) {
                const double theta = low + half * (2.0 * i + 1.0 + nodes[k]);
                points.push_back({std::cos(theta), 2.0 * pi * std::sin(theta) * half * weights[k] * evaluate(theta)});
            }
    }
    constexpr std::size_t perTask = 256;
    const std::size_t tasks = (points.size() + perTask - 1) / perTask;
    const auto orders = static_cast<std::size_t>(count);
    std::vector<std::vector<double>> partial(tasks, std::vector<double>(orders, 0.0));
    tbb::parallel_for(std::size_t{0}, tasks, [&](std::size_t task) {
        std::array<double, perTask> before{}, value{}, cosine{};
        const std::size_t first = task * perTask, used = std::min(perTask, points.size() - first);
        for (std::size_t i = 0; i < used; ++i) {
            cosine[i] = points[first + i].cosine;
            value[i] = points[first + i].weight;
        }
        for (std::size_t l = 0; l < orders; ++l) {
            const double order = static_cast<double>(l);
            const double a = (2.0 * order + 1.0) / (order + 1.0), b = order / (order + 1.0);
            double sum = 0.0;
            for (std::size_t i = 0; i < perTask; ++i) {
                sum += value[i];
                const double next = a * cosine[i] * value[i] - b * before[i];
                before[i] = value[i];
                value[i] = next;
            }
            partial[task][l] = sum;
        }
    });
    std::vector<double> sums(orders, 0.0);
    for (const std::vector<double>& part : partial)
        for (std::size_t l = 0; l < orders; ++l) sums[l] += part[l];
    return sums;
}

double TabulatedPhase::lobeWidth() const {
    constexpr double widest = 0.25, narrowest = 1e-4;
    for (std::size_t i = 1; i < angles_.size() && angles_[i] < widest; ++i)
        if (values_[i] <= 0.5 * values_.front()) return std::max(angles_[i], narrowest);
    return widest;
}

}  // namespace lumulus::phase
