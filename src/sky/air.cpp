#include "sky/air.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lumulus::sky {

namespace {

using std::numbers::pi;

constexpr double moleculeHeight = 8000.0, aerosolHeight = 1200.0;  // m
constexpr double ozoneMiddle = 25000.0, ozoneHalfWidth = 15000.0;  // m
constexpr double aerosolAlbedo = 0.92;
constexpr double perKilometre = 1e-3;

/// Hillaire (2020): 440, 550 and 680 nm stand for blue, green and red; the fourth lane repeats the third and is unused.
Air hillaire(const scene::Sky& sky) {
    Air air;
    air.wavelengths = {440.0, 550.0, 680.0, 680.0};
    air.molecules = perKilometre * Spectrum(0.0331, 0.013558, 0.005802, 0.005802);
    air.aerosolScattering = perKilometre * Spectrum(0.003996);
    air.aerosolExtinction = perKilometre * Spectrum(0.00444);
    air.ozone = perKilometre * Spectrum(0.000085, 0.001881, 0.00065, 0.00065);
    air.asymmetry = 0.8;
    air.groundAlbedo = air.reflectance(sky.groundAlbedo);
    // the three are taken for the primaries of Rec. 709, with the sun's colour of the other media
    air.colours = {{0.0, 0.0, 185.23}, {0.0, 189.23, 0.0}, {210.45, 0.0, 0.0}, {0.0, 0.0, 0.0}};
    return air;
}

}  // namespace

AirDensity airDensity(double height) {
    if (height > 1e5) return {};
    return {std::exp(-height / moleculeHeight), std::exp(-height / aerosolHeight),
            std::max(0.0, 1.0 - std::abs(height - ozoneMiddle) / ozoneHalfWidth)};
}

double moleculePhase(double cosine) {
    return 3.0 / (16.0 * pi) * (1.0 + cosine * cosine);
}

Spectrum Air::reflectance(const glm::dvec3& rgb) const {
    Spectrum made(rgb.r);  // 640 and 680 nm
    for (int i = 0; i < 4; ++i) {
        if (wavelengths[i] < 480.0)
            made[i] = rgb.b;
        else if (wavelengths[i] < 555.0)
            made[i] = rgb.g;
        else if (wavelengths[i] < 600.0)
            made[i] = 0.75 * rgb.g + 0.25 * rgb.r;
    }
    return made;
}

double Air::aerosolPhase(double cosine) const {
    const double g = asymmetry, g2 = g * g;
    const double away = 1.0 + g2 - 2.0 * g * cosine;
    return 3.0 / (8.0 * pi) * (1.0 - g2) * (1.0 + cosine * cosine) / ((2.0 + g2) * away * std::sqrt(away));
}

std::array<double, 5> Air::aerosolMoments() const {
    std::array<double, 5> moments{};
    constexpr int steps = 4000;
    for (int i = 0; i < steps; ++i) {
        const double c = -1.0 + 2.0 * (i + 0.5) / steps, p = aerosolPhase(c);
        double before = 0.0, polynomial = 1.0;  // Legendre's
        for (std::size_t l = 0; l < moments.size(); ++l) {
            moments[l] += p * polynomial;
            const auto n = static_cast<double>(l);
            const double next = ((2.0 * n + 1.0) * c * polynomial - n * before) / (n + 1.0);
            before = polynomial;
            polynomial = next;
        }
    }
    const double whole = moments[0];
    for (double& moment : moments) moment /= whole;
    return moments;
}

double moleculeDepth(double wavelength) {
    const double l2 = std::pow(1e-3 * wavelength, 2);
    return 0.0021520 * (1.0455996 - 341.29061 / l2 - 0.90230850 * l2) / (1.0 + 0.0027059889 / l2 - 85.968563 * l2);
}

Air airOf(const scene::Sky& sky) {
    if (sky.hillaire) return hillaire(sky);
    Air air;
    air.wavelengths = {440.0, 520.0, 560.0, 640.0};
    for (int i = 0; i < 4; ++i) {
        const double wavelength = air.wavelengths[i];
        air.molecules[i] = moleculeDepth(wavelength) / moleculeHeight;
        air.aerosolExtinction[i] = sky.aerosolDepth / aerosolHeight * std::pow(wavelength / 500.0, -sky.angstrom);
    }
    air.aerosolScattering = aerosolAlbedo * air.aerosolExtinction;
    air.ozone = sky.ozone / 300.0 * perKilometre * Spectrum(0.000085, 0.001149, 0.002293, 0.001431);
    air.groundAlbedo = air.reflectance(sky.groundAlbedo);
    air.colours = {{10.10, -13.65, 165.14}, {-143.93, 114.73, 66.37}, {205.85, 92.38, -45.35}, {138.43, -4.23, -0.93}};
    return air;
}

}  // namespace lumulus::sky
