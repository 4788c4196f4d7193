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
constexpr double photonsInCell = 24.0, fewestAlong = 32.0;
/// Photons that a cell is taken to have met, as many as its collectors have there on average, beside those that were
/// counted: what holds the noise of cells that few meet (docs/error-time.md).
constexpr double priorPhotons = 5.0;
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
    const double wanted = std::cbrt(photonsInCell * occupiedVoxels(cloud) / static_cast<double>(photons));
    cloud::CellGrid grid;
    grid.edge = std::max(1, static_cast<int>(std::lround(std::min(wanted, longest / fewestAlong))));
    grid.cells = (cloud.size + grid.edge - 1) / grid.edge;
    while (grid.count() > maxCells) {
        ++grid.edge;
        grid.cells = (cloud.size + grid.edge - 1) / grid.edge;
    }
    return grid;
}

LightField::LightField(gpu::Context& context, const cloud::Cloud& cloud, const cloud::CellGrid& grid)
    : cloud_(cloud),
      grid_(grid),
      massProgram_(context, "light_mass", spirv::light_mass_comp),
      cellsProgram_(context, "light_cells", spirv::light_cells_comp),
      smoothProgram_(context, "light_smooth", spirv::light_smooth_comp),
      mass_(context, "light cell mass", grid_.cells, VK_FORMAT_R32_SFLOAT),
      cells_(context, "light cells", grid_.cells, VK_FORMAT_R32G32B32A32_SFLOAT),
      image_(context, "light field", grid_.cells, VK_FORMAT_R32G32B32A32_SFLOAT) {
    gpu::Commands commands(context);
    commands.begin();
    commands.dispatch(massProgram_, {{"density", cloud_.density, gpu::Sampler::linear}, {"cellMass", mass_}}, push({}),
                      gpu::linearGroups(grid_.count(), 64));
    commands.submit();
    commands.wait();
}

shared::LightFieldPush LightField::push(const Deposits& deposits) const {
    shared::LightFieldPush push{};
    push.size = cloud_.size;
    push.grid = grid_.cells;
    push.edge = grid_.edge;
    push.scale = 1.0F / glm::vec3(grid_.cells);
    push.depositBase = deposits.base;
    push.depositScale = static_cast<float>(deposits.unit);
    push.massScale = static_cast<float>(deposits.massScale);
    push.prior = static_cast<float>(priorPhotons * deposits.photonPower);
    return push;
}

glm::vec3 LightField::scale() const {
    return 1.0F / glm::vec3(grid_.cells * grid_.edge);
}

void LightField::record(gpu::Commands& commands, const gpu::Buffer& radiance, const gpu::Buffer& sum,
                        const Deposits& deposits) const {
    const shared::LightFieldPush values = push(deposits);
    const glm::uvec3 groups = gpu::linearGroups(grid_.count(), 64);
    commands.pass("light field");
    commands.dispatch(cellsProgram_,
                      {{"density", cloud_.density, gpu::Sampler::nearest},
                       {"collectorIndex", cloud_.collectorIndex, gpu::Sampler::nearest},
                       {"Radiance", radiance},
                       {"cells", cells_},
                       {"cellMass", mass_, gpu::Sampler::nearest},
                       {"Deposits", sum}},
                      values, groups);
    commands.barrier("light cells");
    commands.dispatch(smoothProgram_, {{"cells", cells_, gpu::Sampler::linear}, {"lightField", image_}}, values,
                      groups);
}

}  // namespace lumulus::draw
