#include "light/cell_layout.h"

#include <algorithm>

#include "gpu/commands.h"
#include "gpu/groups.h"
#include "gpu/transfer.h"

namespace lumulus::light {

namespace {

namespace spirv {
#include "spirv/light/light_mass.comp.h"
}  // namespace spirv

/// Fills the mass of each cell.
LitCells findLitCells(gpu::Context& context, const MassProgram& program, const cloud::Asset& asset,
                      const cloud::CellGrid& grid, const gpu::Image& mass, const gpu::Image& centres) {
    const cloud::MajorantGrid& majorants = asset.cellImage ? asset.cells : asset.majorants;
    shared::LightMassPush push{};
    push.size = asset.size;
    push.grid = grid.cells;
    push.edge = grid.edge;
    push.perMajorant = 1.0F / majorants.cellSize;
    push.majorantCells = majorants.cells;
    gpu::Commands commands(context);
    commands.begin();
    commands.dispatch(program,
                      {{"density", *asset.density, gpu::Sampler::linear},
                       {"bricks", asset.brickIndex(), gpu::Sampler::nearest},
                       {"cellMass", mass},
                       {"massCentres", centres},
                       {"majorants", asset.marchedCells()}},
                      push, gpu::linearGroups(grid.count(), 64));
    commands.submit();
    commands.wait();
    return litCells(grid.cells, gpu::download<float>(context, mass));
}

}  // namespace

const MassProgram& MassProgramOnce::of(gpu::Context& context, const cloud::Asset& asset) {
    if (!program_) program_.emplace(context, "light_mass", spirv::light_mass_comp, std::vector{asset.sparseConstant()});
    return *program_;
}

CellLayout::CellLayout(gpu::Context& context, const MassProgram& program, const cloud::Asset& asset,
                       const cloud::CellGrid& cells)
    : grid(cells),
      mass(context, "light cell mass", grid.cells, VK_FORMAT_R32_SFLOAT),
      massCentres(context, "light cell centres", grid.cells, VK_FORMAT_R8G8B8A8_UNORM),
      lit(findLitCells(context, program, asset, grid, mass, massCentres)),
      litCells(gpu::filledBuffer(context, "lit cells", lit.numbers)) {}

std::shared_ptr<const CellLayout> CellLayouts::of(gpu::Context& context, const cloud::Asset& asset,
                                                  const cloud::CellGrid& grid) {
    const auto known = std::ranges::find_if(known_, [&](const auto& layout) { return layout->grid == grid; });
    if (known != known_.end()) return *known;
    return known_.emplace_back(std::make_shared<const CellLayout>(context, program_->of(context, asset), asset, grid));
}

}  // namespace lumulus::light
