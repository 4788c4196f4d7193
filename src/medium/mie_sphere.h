#pragma once

#include <complex>
#include <vector>

/// Scattering of a plane wave by a sphere (Mie 1908), as Bohren and Huffman (1983, ch. 4) write it.
namespace lumulus::phase {

/// Coefficients a_n, b_n of the scattered field, n = 1…; element 0 is n = 1.
struct MieCoefficients {
    std::vector<std::complex<double>> a, b;
};

/// Coefficients of a sphere without absorption. `size` is 2π radius / wavelength, above 0 and at most 20,000; `index`
/// the refractive index over that of the medium outside, above 1. As many terms as Wiscombe (1980) found enough.
MieCoefficients mieCoefficients(double size, double index);

/// Scattering cross section over the sphere's own.
double scatteringEfficiency(const MieCoefficients& sphere, double size);

/// Mean cosine of scattering.
double asymmetry(const MieCoefficients& sphere);

/// Radar backscattering cross section over the sphere's own.
double backscatteringEfficiency(const MieCoefficients& sphere, double size);

/// The intensity (|S₁|² + |S₂|²)/2 that unpolarised light has after scattering by the angle with this cosine.
double mieIntensity(const MieCoefficients& sphere, double cosine);

}  // namespace lumulus::phase
