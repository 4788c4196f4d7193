#include "light/light_field.h"

#include <algorithm>
#include <cmath>
#include <glm/gtx/component_wise.hpp>
#include <utility>

#include "gpu/groups.h"
#include "gpu/transfer.h"

namespace lumulus::light {

namespace {

namespace spirv {
#include "spirv/light/light_cells.comp.h"
#include "spirv/light/light_counts.comp.h"
#include "spirv/light/light_smooth.comp.h"
}  // namespace spirv

/// Photons of the map for each cell with density: as fine as the light changes near the surface, as coarse as the noise
/// asks (docs/experiments/light-field-cells.md has the figures).
constexpr double photonsInCell = 16.0;
/// 64 MiB each for the counts, the cells and the smoothed field.
constexpr std::uint64_t maxCells = 1ULL << 22U;
/// With a ring round them they fit into 2048 texels, the least that desktop devices have along a volume.
constexpr int maxAlong = 2046;

/// Voxels with density.
double occupiedVoxels(const cloud::Asset& cloud) {
    double voxels = 0.0;
    for (const cloud::Collector& collector : cloud.collectors) voxels += collector.occupiedVoxels();
    return voxels;
}

}  // namespace

cloud::CellGrid lightGrid(const cloud::Asset& cloud, std::uint64_t photons, double fewestAlong) {
    const int longest = glm::compMax(cloud.size);
    const double wanted = std::min(std::cbrt(photonsInCell * occupiedVoxels(cloud) / static_cast<double>(photons)),
                                   longest / fewestAlong);
    cloud::CellGrid grid;
    grid.edge = 1 << std::max(0L, std::lround(std::log2(wanted)));
    grid.cells = (cloud.size + grid.edge - 1) / grid.edge;
    while (grid.count() > maxCells || glm::compMax(grid.cells) > maxAlong) {
        grid.edge *= 2;
        grid.cells = (cloud.size + grid.edge - 1) / grid.edge;
    }
    return grid;
}

cloud::CellGrid coarseLightGrid(const cloud::Asset& cloud, const cloud::CellGrid& fine) {
    cloud::CellGrid grid;
    grid.edge = 2 * fine.edge;
    grid.cells = (cloud.size + grid.edge - 1) / grid.edge;
    return grid;
}

LightCells::LightCells(gpu::Context& context, const cloud::Asset& asset, const cloud::CellGrid& grid,
                       const cloud::CellGrid& estimates)
    : LightCells(context, asset, CellLayouts().of(context, asset, grid), estimates, asset.voxelToMetres, 0) {}

LightCells::LightCells(gpu::Context& context, const cloud::Asset& asset, std::shared_ptr<const CellLayout> layout,
                       const cloud::CellGrid& estimates, const glm::dmat3& voxelToMetres, std::uint32_t firstCollector,
                       bool coarse)
    : asset_(&asset),
      layout_(std::move(layout)),
      estimatorGrid_(estimates),
      voxelToMetres_(voxelToMetres),
      firstCollector_(firstCollector),
      countsProgram_(context, "light_counts", spirv::light_counts_comp,
                     {gpu::SpecConstant::of(0, grid().edge), asset.sparseConstant()}),
      cellsProgram_(context, "light_cells", spirv::light_cells_comp,
                    {gpu::SpecConstant::of(0, grid().edge), gpu::SpecConstant::of(1, coarse), asset.sparseConstant()}),
      smoothProgram_(context, "light_smooth", spirv::light_smooth_comp),
      counts_(context, "light counts", grid().cells, VK_FORMAT_R32G32B32A32_SFLOAT),
      trust_(context, "light cell trust", grid().cells, VK_FORMAT_R32G32_SFLOAT) {}

LightField::LightField(gpu::Context& context, const cloud::CellGrid& grid)
    : grid_(grid),
      cells_(context, "light cells", grid_.cells + 2, VK_FORMAT_R32G32B32A32_SFLOAT),
      image_(context, "light field", grid_.cells, VK_FORMAT_R32G32B32A32_SFLOAT) {
    // what is not in the list stays dark
    for (gpu::Image* image : {&cells_, &image_}) gpu::upload(context, *image, std::vector<std::byte>(image->bytes()));
}

shared::LightFieldPush LightCells::push() const {
    shared::LightFieldPush push{};
    push.size = asset_->size;
    push.grid = grid().cells;
    push.edge = grid().edge;
    push.voxelToWorld = glm::mat3(voxelToMetres_);
    push.firstCollector = firstCollector_;
    return push;
}

glm::vec3 LightField::scale() const {
    return 1.0F / glm::vec3(grid_.cells * grid_.edge);
}

void LightCells::recordCounts(gpu::Commands& commands, const gpu::Image& fluences,
                              const CollisionEstimates& estimates) const {
    shared::LightCountsPush values{};
    values.size = asset_->size;
    values.grid = grid().cells;
    values.estimatorCells = estimatorGrid_.cells;
    values.estimatorAcross = grid().edge / estimatorGrid_.edge;
    values.estimatorBase = estimates.base;
    values.estimatorScale = static_cast<float>(estimates.unit);
    values.massScale = static_cast<float>(estimates.massScale);
    values.photon = static_cast<float>(estimates.photonPower);
    values.moment = static_cast<float>(estimates.moment);
    // mass / edge³ is the mean density, times σt' (1 − g') and the edge in metres
    const double voxel = std::cbrt(std::abs(glm::determinant(voxelToMetres_)));
    values.thickness = static_cast<float>(estimates.massScale * (1.0 - estimates.moment) /
                                          (voxel * voxel * grid().edge * grid().edge));
    values.occupied = layout_->lit.occupied;
    values.firstCollector = firstCollector_;
    commands.pass("light counts");
    commands.dispatch(countsProgram_,
                      {{"density", *asset_->density, gpu::Sampler::nearest},
                       {"bricks", asset_->brickIndex(), gpu::Sampler::nearest},
                       {"collectorIndex", asset_->collectorIndex, gpu::Sampler::nearest},
                       {"fluences", fluences},
                       {"CollisionEstimates", estimates.counts},
                       {"cellMass", layout_->mass},
                       {"counts", counts_},
                       {"trust", trust_},
                       {"LitCells", layout_->litCells}},
                      values, gpu::linearGroups(layout_->lit.occupied, 64));
    commands.barrier("light counts");
}

void LightField::record(gpu::Commands& commands, const LightCells& of, const glm::vec3& eyeVoxel,
                        const gpu::Image& radiance, const gpu::Image& colours) const {
    const cloud::Asset& asset = of.asset();
    const CellLayout& layout = *of.layout_;
    shared::LightFieldPush values = of.push();
    values.eye = eyeVoxel;
    values.occupied = layout.lit.occupied;
    values.lit = static_cast<std::uint32_t>(layout.lit.numbers.size());
    commands.pass("light field");
    commands.dispatch(of.cellsProgram_,
                      {{"density", *asset.density, gpu::Sampler::nearest},
                       {"bricks", asset.brickIndex(), gpu::Sampler::nearest},
                       {"collectorIndex", asset.collectorIndex, gpu::Sampler::nearest},
                       {"radiance", radiance},
                       {"colours", colours},
                       {"counts", of.counts_},
                       {"cells", cells_},
                       {"LitCells", layout.litCells}},
                      values, gpu::linearGroups(layout.lit.occupied, 64));
    commands.barrier("light cells");
    commands.dispatch(of.smoothProgram_,
                      {{"cells", cells_},
                       {"trust", of.trust_},
                       {"massCentres", layout.massCentres},
                       {"lightField", image_},
                       {"LitCells", layout.litCells}},
                      values, gpu::linearGroups(layout.lit.numbers.size(), 64));
}

}  // namespace lumulus::light
