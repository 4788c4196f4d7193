#pragma once

#include <glm/glm.hpp>

#include "scene/sky.h"

namespace lumulus::reference {

/// A quantity at the four wavelengths of an atmosphere: 440, 520, 560 and 640 nm.
using Four = glm::dvec4;

/// Densities of the air's parts over those that their coefficients belong to; or the integral of these along a way,
/// in metres.
struct AirParts {
    double molecules = 0.0;
    double aerosol = 0.0;
    double ozone = 0.0;

    AirParts& operator+=(const AirParts& other) {
        molecules += other.molecules;
        aerosol += other.aerosol;
        ozone += other.ozone;
        return *this;
    }
    AirParts operator*(double factor) const { return {factor * molecules, factor * aerosol, factor * ozone}; }
};

/// Height of the top of the air above the ground, metres.
inline constexpr double airTop = 100e3;

/// The densities at a height above the ground in metres: molecules e^(−h/8 km), aerosol e^(−h/1.2 km), ozone a tent
/// from 10 over 25 to 40 km (Bruneton 2017).
AirParts airPartsAt(double height);

/// What the air does to light at the four wavelengths, and what colour four wavelengths have. 1/m where the density is
/// 1.
struct AirMedium {
    Four molecules{0.0};          ///< scattering
    Four aerosolScattering{0.0};  ///< scattering
    Four aerosol{0.0};            ///< extinction
    Four ozone{0.0};              ///< absorption
    double aerosolG = 0.7;        ///< of its phase function (Cornette and Shanks 1992)

    /// Rec. 709 in W/m² of sunlight above the air, times each wavelength's share.
    glm::dmat4x3 toRgb{0.0};
    /// What is given in RGB, at the wavelengths: 440 nm has B, 520 nm G, 640 nm R, and 560 nm three quarters of G and a
    /// quarter of R.
    glm::dmat3x4 fromRgb{{0.0, 0.0, 0.25, 1.0}, {0.0, 1.0, 0.75, 0.0}, {1.0, 0.0, 0.0, 0.0}};

    /// The medium of `sky`: molecules by Bodhaine 1999, aerosol by its depth and Ångström exponent with an albedo of
    /// 0.92, ozone by its column; or that of Hillaire 2020, whose 440, 550 and 680 nm stand for blue, green and red
    /// (the fourth wavelength is then 680 nm too and has no colour).
    static AirMedium of(const scene::Sky& sky);

    Four scattering(const AirParts& parts) const {
        return parts.molecules * molecules + parts.aerosol * aerosolScattering;
    }
    /// 1/m of densities; optical depth of their integrals.
    Four extinction(const AirParts& parts) const {
        return parts.molecules * molecules + parts.aerosol * aerosol + parts.ozone * ozone;
    }
    /// A reflectance given in RGB.
    Four spread(const glm::dvec3& rgb) const { return fromRgb * rgb; }
    /// Light that has this colour, W/m² or W/(m² sr) in Rec. 709; parts may be negative.
    Four lightOf(const glm::dvec3& rgb) const;
};

}  // namespace lumulus::reference
