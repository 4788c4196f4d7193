#pragma once

#include <array>

/// Curves that bring scene radiance (linear Rec. 709, 0 and up) to what a display can show. Each maps 0 to 0 or nearly
/// so, and is monotone in grey.
namespace lumulus {

enum class ToneCurve { filmic, agx, aces, neutral, linear };

using Colour = std::array<double, 3>;  ///< red, green, blue

/// The filmic curve of one channel (Narkowicz 2015, "ACES filmic tone mapping curve"), display-linear in [0,1].
double filmicCurve(double radiance);

/// The ACES reference rendering and output transforms as fitted by Hill (2017), display-linear in [0,1].
Colour acesCurve(const Colour& radiance);

/// Khronos PBR Neutral (2024): colours below 0.8 keep their hue and nearly their value. Display-linear in [0,1].
Colour neutralCurve(const Colour& radiance);

/// AgX (Sobotka 2022) with the polynomial of Wrensch (2023): values of the display in [0,1], encoded already.
Colour agxEncoded(const Colour& radiance);

/// The transfer function of sRGB (IEC 61966-2-1) of a display-linear value; 1 from 1 on.
double srgbEncoded(double linear);

/// Encoded values of a display in [0,1] by the curve. Channels that are negative or not numbers count as 0, infinite
/// ones as very bright.
Colour displayed(ToneCurve curve, const Colour& radiance);

}  // namespace lumulus
