#include "medium/mie.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "medium/mie_sphere.h"

namespace lumulus::phase {
namespace {

using std::numbers::pi;

constexpr std::size_t lanes = 8;  // angles that are summed together
/// Distance of size parameters at which the glory is good to 3 %: it comes from narrow resonances. Large droplets have
/// so many of them that fewer sizes do.
constexpr double closestSizes = 0.15;
constexpr double fewestSizes = 350.0, mostWork = 1e5;

/// The coefficients of one sphere as sums over n need them: factor (a+b), factor (a−b), real and imaginary.
struct Sphere {
    double weight = 0.0;
    std::vector<std::array<double, 4>> terms;
};

/// Density of r² n(r) at r/r_eff, up to a factor: a gamma distribution of shape 1/v.
double crossSectionDensity(double ratio, double variance) {
    const double shape = 1.0 / variance;
    return std::exp((shape - 1.0) * std::log(ratio) - (ratio - 1.0) * shape);
}

/// The range of r/r_eff in which the density is above a share of 1e−4 of its maximum.
std::array<double, 2> rangeOf(double variance) {
    const double mode = std::max(1.0 - variance, 1e-3), top = crossSectionDensity(mode, variance);
    double low = mode, high = mode;
    while (low > 0.02 && crossSectionDensity(low, variance) > 1e-4 * top) low *= 0.98;
    while (crossSectionDensity(high, variance) > 1e-4 * top) high *= 1.02;
    return {low, high};
}

Sphere sphereOf(double size, double index, double weight) {
    const MieCoefficients c = mieCoefficients(size, index);
    Sphere sphere{weight, {}};
    sphere.terms.reserve(c.a.size());
    for (std::size_t i = 0; i < c.a.size(); ++i) {
        const double n = static_cast<double>(i) + 1.0, factor = (2.0 * n + 1.0) / (n * (n + 1.0));
        const std::complex<double> plus = factor * (c.a[i] + c.b[i]), minus = factor * (c.a[i] - c.b[i]);
        sphere.terms.push_back({plus.real(), plus.imag(), minus.real(), minus.imag()});
    }
    return sphere;
}

/// Spheres of the distribution; `size` is the size parameter of the effective radius.
std::vector<Sphere> spheresOf(double size, double variance, double index) {
    const auto [low, high] = rangeOf(variance);
    const double extent = size * (high - low);
    const double most = std::max(fewestSizes, mostWork / size);
    const auto count = static_cast<std::size_t>(std::clamp(extent / closestSizes, fewestSizes, most));
    const double step = (high - low) / static_cast<double>(count);
    std::vector<Sphere> spheres(count);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
        // where spheres are too far from each other for their interference, irregular distances make noise of rings
        const double golden = 0.6180339887498949 * static_cast<double>(i);
        const double shift = 0.7 * (golden - std::floor(golden) - 0.5);
        const double ratio = low + (static_cast<double>(i) + 0.5 + shift) * step;
        spheres[i] = sphereOf(size * ratio, index, crossSectionDensity(ratio, variance) / (ratio * ratio));
    });
    return spheres;
}

/// Angles from 0 to π, the same from both ends: fine enough there for diffraction and glory, and for bows between.
std::vector<double> anglesOf(double size) {
    const double finest = 0.15 / size, coarsest = std::clamp(1.0 / size, 0.003, 0.006);
    std::vector<double> angles{0.0};
    for (double step = finest; angles.back() + 0.5 * step < 0.5 * pi; step = std::min(1.05 * step, coarsest))
        angles.push_back(angles.back() + step);
    const double scale = 0.5 * pi / angles.back();
    for (double& angle : angles) angle *= scale;
    for (std::size_t i = angles.size() - 1; i-- > 0;) angles.push_back(pi - angles[i]);
    return angles;
}

using Lanes = std::array<double, lanes>;

/// π_n + τ_n and π_n − τ_n of some angles, n = 1…
struct AngularFunctions {
    std::vector<Lanes> sum, difference;

    AngularFunctions(const Lanes& cosine, std::size_t terms) : sum(terms), difference(terms) {
        Lanes before{}, value{};
        value.fill(1.0);
        for (std::size_t i = 0; i < terms; ++i) {
            const double n = static_cast<double>(i) + 1.0;
            for (std::size_t k = 0; k < lanes; ++k) {
                const double tau = n * cosine[k] * value[k] - (n + 1.0) * before[k];
                sum[i][k] = value[k] + tau;
                difference[i][k] = value[k] - tau;
                const double next = ((2.0 * n + 1.0) * cosine[k] * value[k] - (n + 1.0) * before[k]) / n;
                before[k] = value[k];
                value[k] = next;
            }
        }
    }
};

/// |S₁ + S₂|² + |S₁ − S₂|² of a sphere at some angles.
Lanes intensity(const Sphere& sphere, const AngularFunctions& functions) {
    Lanes plusReal{}, plusImaginary{}, minusReal{}, minusImaginary{};
    for (std::size_t i = 0; i < sphere.terms.size(); ++i) {
        const std::array<double, 4>& c = sphere.terms[i];
        const Lanes& sum = functions.sum[i];
        const Lanes& difference = functions.difference[i];
        for (std::size_t k = 0; k < lanes; ++k) {
            plusReal[k] += c[0] * sum[k];
            plusImaginary[k] += c[1] * sum[k];
            minusReal[k] += c[2] * difference[k];
            minusImaginary[k] += c[3] * difference[k];
        }
    }
    Lanes result{};
    for (std::size_t k = 0; k < lanes; ++k)
        result[k] = plusReal[k] * plusReal[k] + plusImaginary[k] * plusImaginary[k] + minusReal[k] * minusReal[k] +
                    minusImaginary[k] * minusImaginary[k];
    return result;
}

/// Weights of the four wavelengths in red, green and blue of sunlight (METHODS-sky 1), and of these in its luminance.
constexpr std::array<std::array<double, 4>, 3> toRgb{
    {{10.10, -143.93, 205.85, 138.43}, {-13.65, 114.73, 92.38, -4.23}, {165.14, 66.37, -45.35, -0.93}}};
constexpr std::array luminances{0.2126, 0.7152, 0.0722};

}  // namespace

TabulatedPhase miePhase(double effectiveRadius, double effectiveVariance, double wavelength, double index) {
    const double size = 2.0 * pi * effectiveRadius / wavelength;
    const std::vector<Sphere> spheres = spheresOf(size, effectiveVariance, index);
    std::size_t terms = 0;
    for (const Sphere& sphere : spheres) terms = std::max(terms, sphere.terms.size());
    std::vector<double> angles = anglesOf(size);
    std::vector<double> values(angles.size());
    tbb::parallel_for(std::size_t{0}, (angles.size() + lanes - 1) / lanes, [&](std::size_t block) {
        Lanes cosine{};
        for (std::size_t k = 0; k < lanes; ++k)
            cosine[k] = std::cos(angles[std::min(block * lanes + k, angles.size() - 1)]);
        const AngularFunctions functions(cosine, terms);
        Lanes sums{};
        for (const Sphere& sphere : spheres) {
            const Lanes one = intensity(sphere, functions);
            for (std::size_t k = 0; k < lanes; ++k) sums[k] += sphere.weight * one[k];
        }
        for (std::size_t k = 0; k < lanes && block * lanes + k < values.size(); ++k)
            values[block * lanes + k] = sums[k];
    });
    return {std::move(angles), std::move(values)};
}

MieColours mieColours(double effectiveRadius, double effectiveVariance) {
    std::vector<TabulatedPhase> spectrum;
    for (std::size_t i = 0; i < wavelengths.size(); ++i)
        spectrum.push_back(miePhase(effectiveRadius, effectiveVariance, wavelengths[i], waterIndices[i]));
    const std::vector<double>& angles = spectrum.front().angles();  // the finest
    MieColours colours;
    std::vector<double> mean(angles.size(), 0.0);
    for (std::size_t channel = 0; channel < toRgb.size(); ++channel) {
        double white = 0.0;
        for (const double weight : toRgb[channel]) white += weight;
        std::vector<double> values(angles.size());
        for (std::size_t i = 0; i < angles.size(); ++i) {
            double sum = 0.0, least = spectrum.front().values()[i];
            for (std::size_t k = 0; k < spectrum.size(); ++k) {
                const double value = spectrum[k].evaluate(angles[i]);
                sum += toRgb[channel][k] * value;
                least = std::min(least, value);
            }
            // colours outside of Rec. 709 stay above 0
            values[i] = std::max(sum / white, 0.1 * least);
            mean[i] += luminances[channel] * white * values[i];
        }
        colours.channels.emplace_back(angles, std::move(values));
    }
    colours.mean.emplace_back(angles, std::move(mean));
    return colours;
}

}  // namespace lumulus::phase
