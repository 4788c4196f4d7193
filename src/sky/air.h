#pragma once

#include <array>
#include <glm/glm.hpp>

#include "scene/scene.h"

/// What the air is made of, at four wavelengths.
namespace lumulus::sky {

/// A quantity at the wavelengths of `Air::wavelengths`.
using Spectrum = glm::dvec4;

/// Densities relative to those where the coefficients hold.
struct AirDensity {
    double molecules = 0.0, aerosol = 0.0, ozone = 0.0;
};
AirDensity airDensity(double height);

/// The medium of the atmosphere (METHODS: Bodhaine 1999, ASTM G173, Bruneton 2017, or Hillaire 2020). Molecules and
/// aerosol thin out with heights of 8 km and 1.2 km; ozone is a tent from 10 to 40 km with its peak at 25 km.
struct Air {
    Spectrum wavelengths;        ///< nm
    Spectrum molecules;          ///< scattering at the ground [1/m]
    Spectrum aerosolScattering;  ///< at the ground [1/m]
    Spectrum aerosolExtinction;  ///< at the ground [1/m]
    Spectrum ozone;              ///< absorption at the peak [1/m]
    double asymmetry = 0.7;      ///< g of Cornette and Shanks
    Spectrum groundAlbedo;
    /// Rec. 709 in W/m² (or W/(m² sr)) of a transfer, sunlight 1 at all wavelengths: columns are wavelengths.
    glm::mat<4, 3, double> colours;

    Spectrum extinction(const AirDensity& density) const {
        return density.molecules * molecules + density.aerosol * aerosolExtinction + density.ozone * ozone;
    }
    /// Linear Rec. 709 of a transfer [W/m²]; negative where the colour lies outside.
    glm::dvec3 rgb(const Spectrum& transfer) const { return colours * transfer; }
    /// Reflectance at the wavelengths of what is seen as this RGB. Grey stays grey, and the matrix gives back the
    /// colour to within a tenth.
    Spectrum reflectance(const glm::dvec3& rgb) const;
    /// The sun's irradiance above the air at its mean distance, Rec. 709 [W/m²].
    glm::dvec3 sunAbove() const { return rgb(Spectrum(1.0)); }
    /// Phase function of aerosol [1/sr] (Cornette and Shanks 1992).
    double aerosolPhase(double cosine) const;
    /// Its moments ∫ p P_l dω for l = 0 to 4.
    std::array<double, 5> aerosolMoments() const;
};

/// Phase function of molecules [1/sr]; its moments are 1, 0, 0.1.
double moleculePhase(double cosine);

Air airOf(const scene::Sky& sky);

/// Scattering optical depth of all molecules above the ground at a wavelength in nm (Bodhaine 1999, eq. 30).
double moleculeDepth(double wavelength);

}  // namespace lumulus::sky
