#pragma once

#include <glm/glm.hpp>
#include <memory>

#include "cloud/asset.h"
#include "gpu/commands.h"
#include "light/cell_layout.h"
#include "shared/draw.h"

namespace lumulus::light {

/// Cells along the longest side that there are at least, however few photons: noise is the lesser evil.
inline constexpr double fewestLightCells = 32.0;

/// Cells of the light field: the more photons in the whole map, the finer. Edges are powers of two.
cloud::CellGrid lightGrid(const cloud::Asset& cloud, std::uint64_t photons, double fewestAlong = fewestLightCells);

/// Twice as large cells, for pictures to be enlarged. Their radiance towards an eye is that of eight voxels.
cloud::CellGrid coarseLightGrid(const cloud::Asset& cloud, const cloud::CellGrid& fine);

/// What the photon map counted in the cells.
struct CollisionEstimates {
    const gpu::Buffer& counts;
    std::uint32_t base = 0;    ///< index of the first in `counts`
    double unit = 0.0;         ///< W of a count
    double photonPower = 0.0;  ///< mean luminance of a photon [W]
    double massScale = 0.0;    ///< ∫ normalised density [voxels] → ∫ σt' dV [m²]
    double moment = 0.0;       ///< of the phase function, of band 1
};

/// What the light field of a cloud needs whatever the view: which cells are looked up (CellLayout), and what photons
/// counted in them against the collectors' fluences. Collectors drawn one by one would show as blocks, and their noise
/// as grain.
class LightCells {
  public:
    /// Of an instance whose voxels have these edges in the world [m], and whose collectors begin with this number among
    /// those of all instances. The cells of `estimates` are those of the layout, which is of the asset, or finer.
    /// `asset` must outlive it. Where they are `coarse`, a view looks at eight voxels of each.
    LightCells(gpu::Context& context, const cloud::Asset& asset, std::shared_ptr<const CellLayout> layout,
               const cloud::CellGrid& estimates, const glm::dmat3& voxelToMetres, std::uint32_t firstCollector,
               bool coarse = false);
    /// The same of the only instance, with a layout of its own.
    LightCells(gpu::Context& context, const cloud::Asset& asset, const cloud::CellGrid& grid,
               const cloud::CellGrid& estimates);

    /// Records the collision estimates against the collectors' fluences.
    void recordCounts(gpu::Commands& commands, const gpu::Image& fluences, const CollisionEstimates& estimates) const;

    const cloud::Asset& asset() const { return *asset_; }
    const cloud::CellGrid& grid() const { return layout_->grid; }

  private:
    friend class LightField;

    shared::LightFieldPush push() const;

    const cloud::Asset* asset_;
    std::shared_ptr<const CellLayout> layout_;
    cloud::CellGrid estimatorGrid_;
    glm::dmat3 voxelToMetres_;
    std::uint32_t firstCollector_;
    gpu::Program<shared::LightCountsPush> countsProgram_;
    gpu::Program<shared::LightFieldPush> cellsProgram_, smoothProgram_;
    gpu::Image counts_, trust_;
};

/// In-scattered radiance towards one eye as a smooth field: the collectors' values on a grid of cells, scaled and
/// corrected in direction by what was counted there. It belongs to a view.
class LightField {
  public:
    LightField(gpu::Context& context, const cloud::CellGrid& grid);

    /// Records what fills the field for an eye, from the collectors' radiance towards it and their RGB fluence.
    void record(gpu::Commands& commands, const LightCells& cells, const glm::vec3& eyeVoxel, const gpu::Image& radiance,
                const gpu::Image& colours) const;

    /// (Σ L, Σ 1) of cells with density, to be divided after the look-up.
    const gpu::Image& image() const { return image_; }
    /// Voxel coordinates → texture coordinates.
    glm::vec3 scale() const;
    const cloud::CellGrid& grid() const { return grid_; }

  private:
    cloud::CellGrid grid_;
    gpu::Image cells_;  // with a ring of empty ones, which smoothing reads
    gpu::Image image_;
};

}  // namespace lumulus::light
