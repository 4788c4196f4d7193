#pragma once

#include <vector>

#include "light/fog_light/fog_layers.h"

namespace lumulus::fog_light {

/// Moments of phase functions, and streams of a hemisphere times two.
constexpr int momentCount = 32;

/// What light of one colour meets between levels. Phase functions are truncated (delta-M, Wiscombe 1977): what they
/// scatter beyond `momentCount` moments forwards counts as not scattered, and optical depths are less by it.
struct Stack {
    std::vector<double> depth;                   ///< of each interval, from the lowest
    std::vector<std::vector<double>> moments;    ///< of each interval: albedo times the phase function's moments
    std::vector<double> emitted;                 ///< of each interval: emission over extinction [W/(m² sr)]
    std::vector<double> above;                   ///< optical depth above each level
    std::vector<std::vector<double>> scattered;  ///< of each layer, by interval: its σs over all extinction

    std::size_t intervals() const { return depth.size(); }
};

/// The layers between levels, of the channel 0 to 2.
Stack makeStack(const std::vector<FogLayer>& layers, const std::vector<double>& levels, int channel);

}  // namespace lumulus::fog_light
