#pragma once

#include <optional>
#include <span>

#include "base/image.h"

/// Exposure by what a picture shows. Luminance Y is that of Rec. 709 radiance; 683 Y is in cd/m².
namespace lumulus {

/// Factor for radiance at an exposure value (ISO 100): the value 1 of the picture is 1.2 · 2^EV cd/m².
double gainOfEv100(double ev100);

/// EV100 that shows a luminance [W/(m² sr)] as by `gainOfEv100`: the inverse of it.
double ev100OfGain(double gain);

/// Factor for radiance by which the clouds of the pictures, all together, have their 98th percentile of luminance at
/// 0.8 (thesis of Elek, 7.2); where clouds cover less than 2 %, the median of the pictures becomes 0.18, or their 80th
/// percentile 0.6 where that is darker, as from above the air, with half of the picture black. The clouds are
/// taken by themselves from the layers `cloud.R` to `cloud.A`, weighted by `cloud.A`, without sky and sun's disc;
/// without these layers the picture counts, weighted by `A`. At most 2^18 pixels are looked at. Pixels that are
/// not numbers do not count, dark ones in pictures without clouds alone; 1 where all are.
double meteredGain(std::span<const LayeredImage* const> pictures);

/// Factor for radiance by which the median luminance of what is seen beside and through the clouds is 0.18; nothing
/// where that is less than 2 % of the pictures, or dark.
std::optional<double> backgroundGain(std::span<const LayeredImage* const> pictures);

}  // namespace lumulus
