#include "medium/mie_sphere.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

namespace lumulus::phase {
namespace {

/// Number of terms that matter (Wiscombe 1980).
int termsOf(double size) {
    const double root = std::cbrt(size);
    if (size <= 8.0) return static_cast<int>(size + 4.0 * root + 1.0);
    if (size < 4200.0) return static_cast<int>(size + 4.05 * root + 2.0);
    return static_cast<int>(size + 4.0 * root + 2.0);
}

/// The logarithmic derivatives ψ'_n(z)/ψ_n(z), n = 0…count, by the stable recurrence downwards.
std::vector<double> logarithmicDerivatives(double z, int count) {
    const int start = std::max(count, static_cast<int>(z)) + 16 + static_cast<int>(4.0 * std::cbrt(z));
    std::vector<double> derivatives(static_cast<std::size_t>(count) + 1);
    double d = 0.0;
    for (int n = start; n >= 1; --n) {
        if (n <= count) derivatives[static_cast<std::size_t>(n)] = d;
        d = n / z - 1.0 / (d + n / z);
    }
    derivatives[0] = d;
    return derivatives;
}

}  // namespace

MieCoefficients mieCoefficients(double size, double index) {
    assert(size > 0.0 && index > 1.0);
    const int terms = std::max(termsOf(size), 2);
    const std::vector<double> inside = logarithmicDerivatives(index * size, terms);
    MieCoefficients sphere;
    sphere.a.reserve(static_cast<std::size_t>(terms));
    sphere.b.reserve(static_cast<std::size_t>(terms));
    // Riccati–Bessel functions ψ and χ of n − 1 and n, upwards
    double psiBefore = std::cos(size), psi = std::sin(size);
    double chiBefore = -std::sin(size), chi = std::cos(size);
    for (int n = 1; n <= terms; ++n) {
        const double factor = (2.0 * n - 1.0) / size;
        const double psiNext = factor * psi - psiBefore, chiNext = factor * chi - chiBefore;
        psiBefore = psi;
        chiBefore = chi;
        psi = psiNext;
        chi = chiNext;
        const std::complex<double> xi(psi, -chi), xiBefore(psiBefore, -chiBefore);
        const double d = inside[static_cast<std::size_t>(n)];
        const double electric = d / index + n / size, magnetic = d * index + n / size;
        sphere.a.push_back((electric * psi - psiBefore) / (electric * xi - xiBefore));
        sphere.b.push_back((magnetic * psi - psiBefore) / (magnetic * xi - xiBefore));
    }
    return sphere;
}

double scatteringEfficiency(const MieCoefficients& sphere, double size) {
    double sum = 0.0;
    for (std::size_t i = 0; i < sphere.a.size(); ++i)
        sum += (2.0 * static_cast<double>(i) + 3.0) * (std::norm(sphere.a[i]) + std::norm(sphere.b[i]));
    return 2.0 * sum / (size * size);
}

double asymmetry(const MieCoefficients& sphere) {
    double sum = 0.0, scattered = 0.0;
    for (std::size_t i = 0; i < sphere.a.size(); ++i) {
        const double n = static_cast<double>(i) + 1.0;
        scattered += (2.0 * n + 1.0) * (std::norm(sphere.a[i]) + std::norm(sphere.b[i]));
        sum += (2.0 * n + 1.0) / (n * (n + 1.0)) * std::real(sphere.a[i] * std::conj(sphere.b[i]));
        if (i + 1 < sphere.a.size())
            sum += n * (n + 2.0) / (n + 1.0) *
                   std::real(sphere.a[i] * std::conj(sphere.a[i + 1]) + sphere.b[i] * std::conj(sphere.b[i + 1]));
    }
    return 2.0 * sum / scattered;
}

double backscatteringEfficiency(const MieCoefficients& sphere, double size) {
    std::complex<double> sum = 0.0;
    for (std::size_t i = 0; i < sphere.a.size(); ++i) {
        const double sign = i % 2 == 0 ? -1.0 : 1.0;
        sum += (2.0 * static_cast<double>(i) + 3.0) * sign * (sphere.a[i] - sphere.b[i]);
    }
    return std::norm(sum) / (size * size);
}

double mieIntensity(const MieCoefficients& sphere, double cosine) {
    std::complex<double> first = 0.0, second = 0.0;
    double before = 0.0, pi = 1.0;
    for (std::size_t i = 0; i < sphere.a.size(); ++i) {
        const double n = static_cast<double>(i) + 1.0;
        const double tau = n * cosine * pi - (n + 1.0) * before;
        const double factor = (2.0 * n + 1.0) / (n * (n + 1.0));
        first += factor * (sphere.a[i] * pi + sphere.b[i] * tau);
        second += factor * (sphere.a[i] * tau + sphere.b[i] * pi);
        const double next = ((2.0 * n + 1.0) * cosine * pi - (n + 1.0) * before) / n;
        before = pi;
        pi = next;
    }
    return 0.5 * (std::norm(first) + std::norm(second));
}

}  // namespace lumulus::phase
