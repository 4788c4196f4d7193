#pragma once

#include <glm/glm.hpp>

#include "cloud/cloud.h"
#include "gpu/commands.h"
#include "shared/draw.h"

namespace lumulus::draw {

/// Cells of the light field: the more photons in the whole map, the finer.
cloud::CellGrid lightGrid(const cloud::Cloud& cloud, std::uint64_t photons);

/// What the photon map counted in the cells.
struct Deposits {
    std::uint32_t base = 0;    ///< index of the first in the map's sum
    double unit = 0.0;         ///< W of a count
    double photonPower = 0.0;  ///< mean luminance of a photon [W]
    double massScale = 0.0;    ///< ∫ normalised density [voxels] → ∫ σt' dV [m²]
};

/// In-scattered radiance towards the eye as a smooth field: the collectors' values, weighted by mass, on a grid of
/// cells, scaled by what was counted there. Collectors drawn one by one would show as blocks, and their noise as grain.
class LightField {
  public:
    LightField(gpu::Context& context, const cloud::Cloud& cloud, const cloud::CellGrid& grid);

    /// Records what fills the grid from the collectors' radiance and fluence (vec4 each) and the map's sum.
    void record(gpu::Commands& commands, const gpu::Buffer& radiance, const gpu::Buffer& sum,
                const Deposits& deposits) const;

    /// (Σ ρ L, Σ ρ), to be divided after the look-up.
    const gpu::Image& image() const { return image_; }
    /// Voxel coordinates → texture coordinates.
    glm::vec3 scale() const;

  private:
    const cloud::Cloud& cloud_;
    cloud::CellGrid grid_;
    gpu::Program<shared::LightFieldPush> massProgram_, cellsProgram_, smoothProgram_;
    gpu::Image mass_, cells_, image_;

    shared::LightFieldPush push(const Deposits& deposits) const;
};

}  // namespace lumulus::draw
