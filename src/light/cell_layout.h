#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "cloud/asset.h"
#include "gpu/context.h"
#include "gpu/memory.h"
#include "gpu/program.h"
#include "light/lit_cells.h"
#include "shared/draw.h"

namespace lumulus::light {

/// Finds the masses of cells.
using MassProgram = gpu::Program<shared::LightMassPush>;

/// Makes it when it is needed first, for all clouds of a world, which are stored in one way.
class MassProgramOnce {
  public:
    const MassProgram& of(gpu::Context& context, const cloud::Asset& asset);

  private:
    std::optional<MassProgram> program_;
};

/// What the cells of a light field have of the cloud, whatever the light: their masses, and which of them are looked
/// up. It takes as long to find as a picture takes.
struct CellLayout {
    CellLayout(gpu::Context& context, const MassProgram& program, const cloud::Asset& asset,
               const cloud::CellGrid& cells);

    cloud::CellGrid grid;
    gpu::Image mass;         ///< of each cell: ∫ normalised density [voxels]
    gpu::Image massCentres;  ///< where in each cell the middle of its mass is, from its lower corner [edges of a cell]
    LitCells lit;
    gpu::Buffer litCells;  ///< its numbers
};

/// The layouts of one cloud that were needed so far: each is found once for all lights of the cloud. They are as many
/// as there are sizes of cells, a few. Not for several threads.
class CellLayouts {
  public:
    explicit CellLayouts(std::shared_ptr<MassProgramOnce> program = std::make_shared<MassProgramOnce>())
        : program_(std::move(program)) {}
    /// `asset`: the same one each time.
    std::shared_ptr<const CellLayout> of(gpu::Context& context, const cloud::Asset& asset, const cloud::CellGrid& grid);

  private:
    std::shared_ptr<MassProgramOnce> program_;
    std::vector<std::shared_ptr<const CellLayout>> known_;
};

}  // namespace lumulus::light
