#include "progressive/bias.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace lumulus::progressive {

namespace {

/// relMSE of truncated spherical harmonics, for 1 to 8 bands.
constexpr std::array<double, 8> truncated{0.071, 0.0073, 0.0013, 1.8e-4, 1e-4, 9e-5, 0.0, 0.0};
/// relMSE of light field cells and of leaves as large as the mean free path, with `manyPhotons` photons. Fewer photons
/// have larger cells: a power law fits the measurements from 2e5 photons on. A forward peak that is not cut off and
/// billboards add their own share.
constexpr double space = 0.001, manyPhotons = 8e6, growth = 0.64, withoutCut = 0.0115, billboards = 0.0115;

}  // namespace

double biasEstimate(const scene::Scene& scene, std::uint64_t photons) {
    const auto bands = static_cast<std::size_t>(std::clamp(scene.photonMap.bands, 1, 8));
    const double fewer = manyPhotons / std::clamp(static_cast<double>(photons), 1e4, manyPhotons);
    double bias = truncated[bands - 1] + space * std::pow(fewer, growth);
    if (scene.photonMap.forwardCut == 0.0) bias += withoutCut;
    if (scene.draw.mode == scene::DrawMode::billboards) bias += billboards;
    return bias;
}

}  // namespace lumulus::progressive
