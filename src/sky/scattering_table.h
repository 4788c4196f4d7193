#pragma once

#include <cstdint>

#include "sky/multiple_scattering.h"

/// Where the texels of the table of multiple scattering lie.
namespace lumulus::sky {

/// Between four texels.
struct TableCell {
    std::uint32_t first;
    float sun, height;  // fractions
};

/// Cosine of the sun, and height, of a column and a row.
double sunOfTexel(int i);
double heightOfTexel(int j);
TableCell tableCell(double height, double sun);

/// The share of a place's light that counts: the sun far down lights nothing that the table reaches.
double sunFade(double sun);

/// The direction's part across the upward one, in the plane of the sun.
double acrossTowardsSun(const AirPoint& p);

/// Coefficients as the table keeps them.
MultipleScattering::Incident incidentOf(const std::array<Spectrum, harmonicCount>& coefficients);

/// The moments of aerosol's phase function in single precision.
std::array<float, highestDegree + 1> momentsOf(const Air& air);

}  // namespace lumulus::sky
