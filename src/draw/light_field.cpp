#include "draw/light_field.h"

#include <algorithm>
#include <cmath>

#include "gpu/groups.h"

namespace lumulus::draw {

namespace {

namespace spirv {
#include "spirv/draw/light_cells.comp.h"
#include "spirv/draw/light_mass.comp.h"
#include "spirv/draw/light_smooth.comp.h"
}  // namespace spirv

/// Photons of the map for each cell with density: as fine as the light changes near the surface, as coarse as the noise
/// asks (docs/error-time.md has the figures). Where there are few photons noise is the lesser evil, so that there are
/// this many cells along the longest side at least.
constexpr double photonsInCell = 16.0, fewestAlong = 32.0;
/// Photons that a cell is taken to have met, as many as its collectors have there on average, beside those that were
/// counted: what holds the noise of cells that few meet (docs/error-time.md).
constexpr double priorPhotons = 10.0;
/// 64 MiB each for the cells and for the smoothed field.
constexpr std::uint64_t maxCells = 1ULL << 22U;

/// Voxels with density.
double occupiedVoxels(const cloud::Cloud& cloud) {
    double voxels = 0.0;
    for (const cloud::Collector& collector : cloud.collectors) voxels += collector.occupiedVoxels();
    return voxels;
}

}  // namespace

cloud::CellGrid lightGrid(const cloud::Cloud& cloud, std::uint64_t photons) {
    const int longest = std::max(cloud.size.x, std::max(cloud.size.y, cloud.size.z));
    const double wanted = std::min(std::cbrt(photonsInCell * occupiedVoxels(cloud) / static_cast<double>(photons)),
                                   longest / fewestAlong);
    cloud::CellGrid grid;
    grid.edge = 1 << std::max(0L, std::lround(std::log2(wanted)));
    grid.cells = (cloud.size + grid.edge - 1) / grid.edge;
    while (grid.count() > maxCells) {
        grid.edge *= 2;
        grid.cells = (cloud.size + grid.edge - 1) / grid.edge;
    }
    return grid;
}

LightField::LightField(gpu::Context& context, const cloud::Cloud& cloud, const cloud::CellGrid& grid,
                       const cloud::CellGrid& deposits)
    : cloud_(cloud),
      grid_(grid),
      depositGrid_(deposits),
      massProgram_(context, "light_mass", spirv::light_mass_comp),
      cellsProgram_(context, "light_cells", spirv::light_cells_comp),
      smoothProgram_(context, "light_smooth", spirv::light_smooth_comp),
      mass_(context, "light cell mass", grid_.cells, VK_FORMAT_R32_SFLOAT),
      cells_(context, "light cells", grid_.cells, VK_FORMAT_R32G32B32A32_SFLOAT),
      image_(context, "light field", grid_.cells, VK_FORMAT_R32G32B32A32_SFLOAT) {
    gpu::Commands commands(context);
    commands.begin();
    commands.dispatch(massProgram_, {{"density", cloud_.density, gpu::Sampler::linear}, {"cellMass", mass_}}, push(),
                      gpu::linearGroups(grid_.count(), 64));
    commands.submit();
    commands.wait();
}

shared::LightFieldPush LightField::push() const {
    shared::LightFieldPush push{};
    push.size = cloud_.size;
    push.grid = grid_.cells;
    push.edge = grid_.edge;
    push.scale = 1.0F / glm::vec3(grid_.cells);
    push.depositCells = depositGrid_.cells;
    push.depositsAcross = grid_.edge / depositGrid_.edge;
    return push;
}

glm::vec3 LightField::scale() const {
    return 1.0F / glm::vec3(grid_.cells * grid_.edge);
}

void LightField::record(gpu::Commands& commands, const gpu::Buffer& radiance, const Deposits& deposits) const {
    shared::LightFieldPush values = push();
    values.depositBase = deposits.base;
    values.depositScale = static_cast<float>(deposits.unit);
    values.massScale = static_cast<float>(deposits.massScale);
    values.prior = static_cast<float>(priorPhotons * deposits.photonPower);
    const glm::uvec3 groups = gpu::linearGroups(grid_.count(), 64);
    commands.pass("light field");
    commands.dispatch(cellsProgram_,
                      {{"density", cloud_.density, gpu::Sampler::nearest},
                       {"collectorIndex", cloud_.collectorIndex, gpu::Sampler::nearest},
                       {"Radiance", radiance},
                       {"cells", cells_},
                       {"cellMass", mass_, gpu::Sampler::nearest},
                       {"Deposits", deposits.counts}},
                      values, groups);
    commands.barrier("light cells");
    commands.dispatch(smoothProgram_, {{"cells", cells_, gpu::Sampler::linear}, {"lightField", image_}}, values,
                      groups);
}

}  // namespace lumulus::draw
