#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/interrupt.h"
#include "base/progress.h"
#include "render/renderer.h"

namespace lumulus::bake {

/// Light in a voxel.
struct VoxelLight {
    /// Of all light but what comes straight from the sun: L(ω) ≈ Σ c_i y_i(ω), ω pointing to where it comes from
    /// (render/ambient.h has y_i), RGB [W m⁻² sr^−½].
    std::array<glm::vec3, 9> coefficients{};
    /// Of the sun through clouds, fog and air, on a plane that faces it, RGB [W/m²].
    glm::vec3 sun{0.0F};

    /// Of all light [W/m²].
    glm::vec3 fluence() const;
    /// Net flux of a channel, pointing to where the light goes [W/m²]; `toSun`: unit vector.
    glm::vec3 flux(int channel, const glm::vec3& toSun) const;
};

/// Light on voxels along the axes of the world, where there is density and one voxel around it.
struct LightGrid {
    double voxel = 1.0;  ///< edge [m]; the middle of voxel (i, j, k) is (i, j, k) times the edge
    glm::dvec3 toSun{0.0, 1.0, 0.0};
    std::vector<glm::ivec3> places;  ///< in lexicographic order
    std::vector<VoxelLight> light;   ///< as many
};

/// Refuses, before photons are traced, voxels that bakeLight() would refuse for their size.
void checkVoxels(Renderer& renderer, std::optional<double> voxel);

/// The light in the clouds of a renderer that has traced its photons, for a scene without a forward cut. `voxel`: edge
/// [m]; absent: a 96th of the clouds' longest side. Errors: InputError where there is no light in a cloud and where
/// voxels are too many; what `check` throws.
LightGrid bakeLight(Renderer& renderer, std::optional<double> voxel, const Report& report, const Check& check);

}  // namespace lumulus::bake
