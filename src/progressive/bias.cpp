#include "progressive/bias.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace lumulus::progressive {

namespace {

/// By bands, 1 to 8, with the peak cut at 12°, marched.
constexpr std::array<double, 8> byBands{0.1, 0.03, 0.01, 0.007, 0.007, 0.007, 0.007, 0.007};
/// With 5 bands: what the whole peak left in the walk, and billboards, have more.
constexpr double withoutCut = 0.003, billboards = 0.03;

}  // namespace

double biasEstimate(const scene::Scene& scene) {
    const auto bands = static_cast<std::size_t>(std::clamp(scene.photonMap.bands, 1, 8));
    double bias = byBands[bands - 1];
    if (scene.photonMap.forwardCut == 0.0) bias += withoutCut;
    if (scene.draw.mode == scene::DrawMode::billboards) bias += billboards;
    return bias;
}

}  // namespace lumulus::progressive
