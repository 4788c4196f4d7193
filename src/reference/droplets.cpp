#include "reference/droplets.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <glm/gtc/constants.hpp>

namespace lumulus::reference {
namespace {

using Complex = std::complex<double>;

/// One wavelength [µm] with water's refractive index (Hale and Querry 1973) and its weights in Rec. 709 for sunlight.
struct Line {
    double wavelength, index;
    std::array<double, 3> rgb;
};
constexpr std::array<Line, 4> lines{{{0.44, 1.3374, {10.10, -13.65, 165.14}},
                                     {0.52, 1.3342, {-143.93, 114.73, 66.37}},
                                     {0.56, 1.3330, {205.85, 92.38, -45.35}},
                                     {0.64, 1.3314, {138.43, -4.23, -0.93}}}};
constexpr std::array luminance{0.2126, 0.7152, 0.0722};

/// a_n + b_n and a_n − b_n, times (2n+1)/(n(n+1)), from n = 1.
struct Series {
    double weight = 0.0;
    std::vector<Complex> sum, difference;
};

/// Ratios f_n−1(z)/f_n(z) of the Riccati–Bessel functions that are regular at 0, n = 1…count, downwards from where
/// they are 0 in effect.
std::vector<double> ratios(double z, int count) {
    const int start = count + 40 + static_cast<int>(2.0 * z);
    std::vector<double> result(static_cast<std::size_t>(count) + 1);
    double ratio = (2.0 * start + 1.0) / z;
    for (int n = start; n >= 1; --n) {
        ratio = (2.0 * n + 1.0) / z - 1.0 / ratio;  // f_n−1/f_n from f_n/f_n+1
        if (n <= count) result[static_cast<std::size_t>(n)] = ratio;
    }
    return result;
}

Series seriesOf(double x, double index, double weight) {
    const int count = static_cast<int>(x + 4.3 * std::cbrt(x) + 4.0);
    const std::vector<double> inside = ratios(index * x, count), outside = ratios(x, count);
    Series series{weight, {}, {}};
    double psi = std::sin(x), chiBefore = -std::sin(x), chi = std::cos(x);
    for (int n = 1; n <= count; ++n) {
        const auto at = static_cast<std::size_t>(n);
        const double psiBefore = psi;
        psi = psiBefore / outside[at];
        const double chiNext = (2.0 * n - 1.0) / x * chi - chiBefore;
        chiBefore = chi;
        chi = chiNext;
        const Complex zeta(psi, -chi), zetaBefore(psiBefore, -chiBefore);
        const double electric = inside[at] / index + n / x * (1.0 - 1.0 / (index * index));
        const double magnetic = inside[at] * index;
        const Complex a = (electric * psi - psiBefore) / (electric * zeta - zetaBefore);
        const Complex b = (magnetic * psi - psiBefore) / (magnetic * zeta - zetaBefore);
        const double factor = (2.0 * n + 1.0) / (static_cast<double>(n) * (n + 1.0));
        series.sum.push_back(factor * (a + b));
        series.difference.push_back(factor * (a - b));
    }
    return series;
}

/// The trapezoid rule over the radii of n(r) ~ r^((1−3v)/v) e^(−r/(v r_eff)), in units of the effective radius: it
/// vanishes at both ends.
std::vector<Series> spheres(double x, double index, double variance) {
    const double width = std::sqrt(variance);
    const double from = std::max(0.04, 1.0 - 4.2 * width), to = 1.0 + 6.5 * width + 3.0 * variance;
    const auto steps = static_cast<std::size_t>(std::clamp(9.0 * x * (to - from), 600.0, std::max(700.0, 1.5e5 / x)));
    std::vector<Series> all(steps + 1);
    tbb::parallel_for(std::size_t{0}, steps + 1, [&](std::size_t i) {
        const double r = from + (to - from) * static_cast<double>(i) / static_cast<double>(steps);
        const double power = (1.0 - 3.0 * variance) / variance;
        all[i] = seriesOf(r * x, index, std::exp(power * std::log(r) - (r - 1.0) / variance));
    });
    return all;
}

double intensity(const std::vector<Series>& all, double cosine) {
    std::size_t count = 0;
    for (const Series& one : all) count = std::max(count, one.sum.size());
    std::vector<double> plus(count), minus(count);
    double before = 0.0, value = 1.0;
    for (std::size_t i = 0; i < count; ++i) {
        const double n = static_cast<double>(i + 1);
        const double tau = n * cosine * value - (n + 1.0) * before;
        plus[i] = value + tau;
        minus[i] = value - tau;
        const double next = ((2.0 * n + 1.0) * cosine * value - (n + 1.0) * before) / n;
        before = value;
        value = next;
    }
    double total = 0.0;
    for (const Series& one : all) {
        Complex first = 0.0, second = 0.0;
        for (std::size_t i = 0; i < one.sum.size(); ++i) {
            first += one.sum[i] * plus[i];
            second += one.difference[i] * minus[i];
        }
        total += one.weight * (std::norm(first) + std::norm(second));
    }
    return total;
}

/// Angles that are dense where the light is: steps in proportion to the distance from both ends.
std::vector<double> angles(double x) {
    const double least = 0.12 / x, most = std::max(0.003, std::min(0.005, 0.8 / x));
    std::vector<double> result{0.0};
    while (result.back() < glm::pi<double>() - 0.6 * least) {
        const double end = std::min(result.back(), glm::pi<double>() - result.back());
        result.push_back(result.back() + std::clamp(0.05 * end, least, most));
    }
    result.back() = glm::pi<double>();
    return result;
}

}  // namespace

Droplets makeDroplets(double radius, double variance) {
    const std::vector<double> theta = angles(glm::two_pi<double>() * radius / lines.front().wavelength);
    std::vector<double> places;
    for (const double angle : theta) places.push_back(2.0 * std::pow(std::sin(0.5 * angle), 2.0));
    std::vector<PhaseValues> spectrum;
    for (const Line& line : lines) {
        const double x = glm::two_pi<double>() * radius / line.wavelength;
        const std::vector<Series> all = spheres(x, line.index, variance);
        std::vector<double> values(theta.size());
        tbb::parallel_for(std::size_t{0}, theta.size(),
                          [&](std::size_t i) { values[i] = intensity(all, std::cos(theta[i])); });
        spectrum.emplace_back(places, std::move(values));
    }
    Droplets droplets;
    std::vector<double> mean(theta.size(), 0.0);
    for (std::size_t c = 0; c < 3; ++c) {
        double white = 0.0;
        for (const Line& line : lines) white += line.rgb[c];
        std::vector<double> values(theta.size());
        for (std::size_t i = 0; i < theta.size(); ++i) {
            double least = spectrum.front().evaluate(places[i]);
            for (std::size_t k = 0; k < lines.size(); ++k) {
                const double p = spectrum[k].evaluate(places[i]);
                values[i] += lines[k].rgb[c] / white * p;
                least = std::min(least, p);
            }
            values[i] = std::max(values[i], 0.1 * least);  // outside of Rec. 709
            mean[i] += luminance[c] * white * values[i];
        }
        droplets.colours.emplace_back(places, std::move(values));
    }
    droplets.colours.emplace_back(places, std::move(mean));
    return droplets;
}

}  // namespace lumulus::reference
