#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace lumulus::reference {

/// Pixels per degree of sight for a 4K screen 0.7 m wide, seen from 0.7 m (Andersson 2020).
constexpr double flipPixelsPerDegree = 67.02;

/// The difference that a person sees when flipping between two pictures, per pixel, 0 (none) to 1: LDR-FLIP (Andersson
/// et al. 2020, "FLIP: A Difference Evaluator for Alternating Images"). Pictures are 8-bit sRGB of width·height·3
/// bytes, rows from the top; the edges are continued outwards.
std::vector<float> flip(std::span<const std::uint8_t> image, std::span<const std::uint8_t> reference, int width,
                        int height, double pixelsPerDegree = flipPixelsPerDegree);

/// The mean of the map, which is the value quoted as FLIP.
double flipMean(std::span<const float> map);

}  // namespace lumulus::reference
