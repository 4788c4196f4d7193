#pragma once

#include <array>
#include <vector>

#include "medium/tabulated_phase.h"

/// Droplets of water: their phase functions by Mie's theory, averaged over a gamma distribution of radii
/// n(r) ~ r^((1−3v)/v) exp(−r/(v r_eff)) (Hansen 1971).
namespace lumulus::phase {

/// The wavelengths at which light is computed, µm.
inline constexpr std::array wavelengths{0.44, 0.52, 0.56, 0.64};

/// Refractive index of water at each of them, between the values of Hale and Querry (1973); it does not absorb there.
inline constexpr std::array waterIndices{1.3374, 1.3342, 1.3330, 1.3314};

/// The phase function of droplets at one wavelength. `effectiveRadius` and `wavelength` in µm, `effectiveVariance`
/// above 0 and at most 0.5. Runs on all threads.
TabulatedPhase miePhase(double effectiveRadius, double effectiveVariance, double wavelength, double index);

/// The phase functions of droplets for the eye.
struct MieColours {
    /// Of red, green and blue, by the matrix from four wavelengths to Rec. 709 (METHODS-sky 1) for sunlight.
    std::vector<TabulatedPhase> channels;
    std::vector<TabulatedPhase> mean;  ///< one: their mean by the luminance of sunlight
};

/// Phase functions of red, green and blue of droplets. `effectiveRadius` in µm. Takes tenths of a second on all
/// threads.
MieColours mieColours(double effectiveRadius, double effectiveVariance);

}  // namespace lumulus::phase
