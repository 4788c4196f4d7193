#pragma once

#include <filesystem>

/// Phase functions of clouds (docs/scene-format.md).
namespace lumulus::scene {

enum class PhaseModel { henyeyGreenstein, schlick, rayleigh, hazy, murky, droplet, mie, table };

struct Phase {
    PhaseModel model = PhaseModel::henyeyGreenstein;
    double g = 0.85;
    double dropletDiameter = 20.0;   ///< µm, 5 to 50, for `droplet`
    double effectiveRadius = 10.0;   ///< µm, 2 to 50, for `mie`
    double effectiveVariance = 0.1;  ///< of the gamma distribution of radii, for `mie`
    std::filesystem::path table{};   ///< of angle and value, for `table`

    bool operator==(const Phase&) const = default;
};

}  // namespace lumulus::scene
