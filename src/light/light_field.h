#pragma once

#include <glm/glm.hpp>

#include "cloud/cloud.h"
#include "gpu/commands.h"
#include "light/lit_cells.h"
#include "shared/draw.h"

namespace lumulus::light {

/// Cells of the light field: the more photons in the whole map, the finer. Edges are powers of two.
cloud::CellGrid lightGrid(const cloud::Cloud& cloud, std::uint64_t photons);

/// What the photon map counted in the cells.
struct CollisionEstimates {
    const gpu::Buffer& counts;
    std::uint32_t base = 0;    ///< index of the first in `counts`
    double unit = 0.0;         ///< W of a count
    double photonPower = 0.0;  ///< mean luminance of a photon [W]
    double massScale = 0.0;    ///< ∫ normalised density [voxels] → ∫ σt' dV [m²]
    double moment = 0.0;       ///< of the phase function, of band 1
};

/// In-scattered radiance towards the eye as a smooth field: the collectors' values on a grid of cells, scaled and
/// turned by what was counted there. Only cells that are looked up are filled (LitCells). Collectors drawn one by one
/// would show as blocks, and their noise as grain.
class LightField {
  public:
    /// The cells of `estimates` are those of `grid` or finer.
    LightField(gpu::Context& context, const cloud::Cloud& cloud, const cloud::CellGrid& grid,
               const cloud::CellGrid& estimates);

    /// Records what is the same for all views: the estimates against the collectors' fluences.
    void recordCounts(gpu::Commands& commands, const gpu::Image& fluences, const CollisionEstimates& estimates) const;
    /// Records what fills the grid for an eye, from the collectors' radiance towards it.
    void record(gpu::Commands& commands, const glm::vec3& eyeVoxel, const gpu::Image& radiance) const;

    /// (Σ L, Σ 1) of cells with density, to be divided after the look-up.
    const gpu::Image& image() const { return image_; }
    /// Voxel coordinates → texture coordinates.
    glm::vec3 scale() const;
    const cloud::CellGrid& grid() const { return grid_; }

  private:
    LitCells findLitCells(gpu::Context& context) const;

    const cloud::Cloud& cloud_;
    cloud::CellGrid grid_, estimatorGrid_;
    gpu::Program<shared::LightFieldPush> massProgram_;
    gpu::Program<shared::LightCountsPush> countsProgram_;
    gpu::Program<shared::LightFieldPush> cellsProgram_, smoothProgram_;
    gpu::Image mass_, counts_, ownShare_;
    gpu::Image cells_;  // with a ring of empty ones, which smoothing reads
    gpu::Image image_;
    LitCells lit_;
    gpu::Buffer litCells_;

    shared::LightFieldPush push() const;
};

}  // namespace lumulus::light
