#pragma once

#include <glm/glm.hpp>

namespace lumulus::scene {

/// Colour of a black body of a temperature in K (1000 to 40000) as linear Rec. 709 with a luminance of 1. Channels that
/// would be negative, below 1900 K, are 0. By Planck's law and the fit of Wyman et al. 2013 to the CIE's colour
/// matching functions of 1931.
glm::dvec3 blackBodyColour(double temperature);

/// CIE x and y of the same, before anything is cut off.
glm::dvec2 blackBodyChromaticity(double temperature);

}  // namespace lumulus::scene
