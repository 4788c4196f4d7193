#include "reference/shell_exponential.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "reference/ground.h"

namespace lumulus::reference {
namespace {

/// Powers of e by which the density has fallen from its densest place where pieces of the integral end. What is thinner
/// than the last adds nothing.
constexpr std::array<double, 14> falls{0.7, 1.4, 2.1, 3.0, 4.0, 5.5, 7.0, 9.0, 12.0, 16.0, 22.0, 30.0, 42.0, 60.0};

/// Gauss and Legendre's rule of six points on [−1, 1]: the three above 0.
constexpr std::array<double, 3> nodes{0.2386191860831969, 0.6612093864662645, 0.9324695142031521};
constexpr std::array<double, 3> weights{0.4679139345726910, 0.3607615730481386, 0.1713244923791704};

/// Densities beyond e^460 are no longer told apart.
constexpr double mostExponent = 460.0;

}  // namespace

ShellExponential::ShellExponential(double rate, double zero, double ground, const Ray& ray, const Interval& part)
    : rate_(rate) {
    const glm::dvec3 fromMiddle = ray.origin - glm::dvec3(0.0, ground - planetRadius, 0.0);
    middle_ = -glm::dot(fromMiddle, ray.direction);
    lowestRadius_ = glm::length(glm::cross(fromMiddle, ray.direction));
    exponent_ = rate * (lowestRadius_ - planetRadius + ground - zero);
    begin_ = placeOf(part.begin);
    end_ = placeOf(part.end);
}

double ShellExponential::placeOf(double metres) const {
    if (!std::isfinite(metres)) return std::numeric_limits<double>::infinity();
    const double length = metres - middle_, square = length * length;
    return std::copysign(std::sqrt(square / (std::sqrt(lowestRadius_ * lowestRadius_ + square) + lowestRadius_)),
                         length);
}

double ShellExponential::metresAt(double u) const {
    return middle_ + u * std::sqrt(2.0 * lowestRadius_ + u * u);
}

double ShellExponential::densityAt(double u) const {
    const double square = u * u;
    return std::exp(std::min(-exponent_ - rate_ * square, mostExponent)) * 2.0 * (lowestRadius_ + square) /
           std::sqrt(2.0 * lowestRadius_ + square);
}

/// Breaks of a part without the lowest point, between the places `near` and `far` from it, both at least 0, nearest
/// first and without `near`.
void ShellExponential::breakMonotone(double near, double far, std::vector<double>& to) const {
    const double rate = std::abs(rate_);
    if (rate_ >= 0.0) {
        for (const double fall : falls) {
            const double u = std::sqrt(near * near + fall / rate);
            if (!(u < far)) break;
            to.push_back(u);
        }
        if (!(std::sqrt(near * near + falls.back() / rate) < far)) to.push_back(far);
        return;
    }
    for (std::size_t i = falls.size(); i-- > 0;) {
        const double square = far * far - falls[i] / rate;
        if (square > near * near) to.push_back(std::sqrt(square));
    }
    to.push_back(far);
}

/// Places between which the rule is exact enough, from the first to the last that counts.
std::vector<double> ShellExponential::breaks(double begin, double end) const {
    std::vector<double> places;
    if (begin < 0.0) {
        const double near = end < 0.0 ? -end : 0.0;
        breakMonotone(near, -begin, places);
        std::ranges::reverse(places);
        for (double& u : places) u = -u;
        places.push_back(-near);
    } else {
        places.push_back(begin);
    }
    if (end > 0.0) breakMonotone(std::max(begin, 0.0), end, places);
    return places;
}

double ShellExponential::piece(double begin, double end) const {
    const double middle = 0.5 * (begin + end), half = 0.5 * (end - begin);
    double sum = 0.0;
    for (std::size_t i = 0; i < nodes.size(); ++i)
        sum += weights[i] * (densityAt(middle - half * nodes[i]) + densityAt(middle + half * nodes[i]));
    return half * sum;
}

double ShellExponential::pathTo(double metres) const {
    const double end = std::min(placeOf(metres), end_);
    if (!(begin_ < end)) return 0.0;
    const std::vector<double> places = breaks(begin_, end);
    double sum = 0.0;
    for (std::size_t i = 1; i < places.size(); ++i) sum += piece(places[i - 1], places[i]);
    return sum;
}

double ShellExponential::metresTo(double path) const {
    constexpr double never = std::numeric_limits<double>::infinity();
    if (!(begin_ < end_)) return never;
    const std::vector<double> places = breaks(begin_, end_);
    for (std::size_t i = 1; i < places.size(); ++i) {
        const double from = places[i - 1], whole = piece(from, places[i]);
        if (whole <= path) {
            path -= whole;
            continue;
        }
        // Newton's steps, kept within what is known to hold the place
        double low = from, high = places[i], u = from + (high - from) * (path / whole);
        for (int step = 0; step < 40; ++step) {
            const double miss = piece(from, u) - path;
            (miss > 0.0 ? high : low) = u;
            if (std::abs(miss) <= 1e-12 * whole) break;
            const double next = u - miss / densityAt(u);
            u = next > low && next < high ? next : 0.5 * (low + high);
        }
        return metresAt(u);
    }
    return never;
}

}  // namespace lumulus::reference
