#include "progressive/bias.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace lumulus::progressive {

namespace {

/// Of truncated harmonics, by bands, 1 to 8.
constexpr std::array<double, 8> truncated{0.047, 0.012, 0.0021, 4e-4, 7e-5, 0.0, 0.0, 0.0};
/// Of cells of the light field and of leaves as large as the mean free path: marched, and what the forward peak left in
/// the walk and billboards add.
constexpr double space = 0.007, withoutCut = 0.003, billboards = 0.03;

}  // namespace

double biasEstimate(const scene::Scene& scene) {
    const auto bands = static_cast<std::size_t>(std::clamp(scene.photonMap.bands, 1, 8));
    double bias = truncated[bands - 1] + space;
    if (scene.photonMap.forwardCut == 0.0) bias += withoutCut;
    if (scene.draw.mode == scene::DrawMode::billboards) bias += billboards;
    return bias;
}

}  // namespace lumulus::progressive
