#include "reference/air_medium.h"

#include <algorithm>
#include <cmath>

namespace lumulus::reference {
namespace {

constexpr double perKm = 1e-3;
constexpr double moleculesFalloff = 8e3, aerosolFalloff = 1.2e3;  // m
constexpr double ozoneFoot = 10e3, ozonePeak = 25e3;              // m
constexpr Four nanometres(440.0, 520.0, 560.0, 640.0);

/// Optical depth of all molecules above sea level at 45° latitude, λ in µm (Bodhaine et al. 1999, eq. 30).
double moleculesDepth(double micrometres) {
    const double square = micrometres * micrometres, inverse = 1.0 / square;
    return 0.0021520 * (1.0455996 - 341.29061 * inverse - 0.90230850 * square) /
           (1.0 + 0.0027059889 * inverse - 85.968563 * square);
}

AirMedium hillaire() {
    AirMedium air;
    air.molecules = perKm * Four(0.0331, 0.013558, 0.005802, 0.005802);
    air.aerosolScattering = perKm * Four(0.003996);
    air.aerosol = perKm * Four(0.00444);
    air.ozone = perKm * Four(0.000085, 0.001881, 0.00065, 0.00065);
    air.aerosolG = 0.8;
    air.toRgb = {{0.0, 0.0, 185.23}, {0.0, 189.23, 0.0}, {210.45, 0.0, 0.0}, {0.0, 0.0, 0.0}};
    air.fromRgb = {{0.0, 0.0, 1.0, 1.0}, {0.0, 1.0, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}};
    return air;
}

}  // namespace

AirParts airPartsAt(double height) {
    if (height >= airTop) return {};
    return {std::exp(-height / moleculesFalloff), std::exp(-height / aerosolFalloff),
            std::max(0.0, 1.0 - std::abs(height - ozonePeak) / (ozonePeak - ozoneFoot))};
}

AirMedium AirMedium::of(const scene::Sky& sky) {
    if (sky.hillaire) return hillaire();
    constexpr double aerosolAlbedo = 0.92;
    AirMedium air;
    for (int i = 0; i < 4; ++i) {
        air.molecules[i] = moleculesDepth(1e-3 * nanometres[i]) / moleculesFalloff;
        air.aerosol[i] = sky.aerosolDepth * std::pow(nanometres[i] / 500.0, -sky.angstrom) / aerosolFalloff;
    }
    air.aerosolScattering = aerosolAlbedo * air.aerosol;
    air.ozone = sky.ozone / 300.0 * perKm * Four(0.000085, 0.001149, 0.002293, 0.001431);
    air.toRgb = {{10.10, -13.65, 165.14}, {-143.93, 114.73, 66.37}, {205.85, 92.38, -45.35}, {138.43, -4.23, -0.93}};
    return air;
}

Four AirMedium::lightOf(const glm::dvec3& rgb) const {
    return spread(glm::inverse(toRgb * fromRgb) * rgb);
}

}  // namespace lumulus::reference
