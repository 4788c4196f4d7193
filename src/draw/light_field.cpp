#include "draw/light_field.h"

#include <algorithm>
#include <cmath>

#include "gpu/groups.h"

namespace lumulus::draw {

namespace {

namespace spirv {
#include "spirv/draw/light_cells.comp.h"
#include "spirv/draw/light_smooth.comp.h"
}  // namespace spirv

/// Photons of the map for each cell with density: as fine as the light changes near the surface, as coarse as the noise
/// asks (docs/error-time.md has the figures). Where there are few photons noise is the lesser evil, so that there are
/// this many cells along the longest side at least.
constexpr double photonsInCell = 24.0, fewestAlong = 32.0;
/// 64 MiB each for the cells and for the smoothed field.
constexpr std::uint64_t maxCells = 1ULL << 22U;

std::uint64_t cellCount(const shared::LightFieldPush& push) {
    return static_cast<std::uint64_t>(push.grid.x) * static_cast<std::uint64_t>(push.grid.y) *
           static_cast<std::uint64_t>(push.grid.z);
}

/// Voxels with density.
double occupiedVoxels(const cloud::Cloud& cloud) {
    double voxels = 0.0;
    for (const cloud::Collector& collector : cloud.collectors) voxels += collector.occupiedVoxels();
    return voxels;
}

shared::LightFieldPush gridFor(const cloud::Cloud& cloud, std::uint64_t photons) {
    shared::LightFieldPush push{};
    const glm::ivec3 size = cloud.size;
    const int longest = std::max(size.x, std::max(size.y, size.z));
    const double wanted = std::cbrt(photonsInCell * occupiedVoxels(cloud) / static_cast<double>(photons));
    push.size = size;
    push.edge = std::max(1, static_cast<int>(std::lround(std::min(wanted, longest / fewestAlong))));
    push.grid = (size + push.edge - 1) / push.edge;
    while (cellCount(push) > maxCells) {
        ++push.edge;
        push.grid = (size + push.edge - 1) / push.edge;
    }
    push.scale = 1.0F / glm::vec3(push.grid);
    return push;
}

}  // namespace

LightField::LightField(gpu::Context& context, const cloud::Cloud& cloud, std::uint64_t photons)
    : cloud_(cloud),
      push_(gridFor(cloud, photons)),
      cellsProgram_(context, "light_cells", spirv::light_cells_comp),
      smoothProgram_(context, "light_smooth", spirv::light_smooth_comp),
      cells_(context, "light cells", push_.grid, VK_FORMAT_R32G32B32A32_SFLOAT),
      image_(context, "light field", push_.grid, VK_FORMAT_R32G32B32A32_SFLOAT) {}

glm::vec3 LightField::scale() const {
    return 1.0F / glm::vec3(push_.grid * push_.edge);
}

void LightField::record(gpu::Commands& commands, const gpu::Buffer& radiance) const {
    commands.pass("light field");
    commands.dispatch(cellsProgram_,
                      {{"density", cloud_.density, gpu::Sampler::nearest},
                       {"collectorIndex", cloud_.collectorIndex, gpu::Sampler::nearest},
                       {"Radiance", radiance},
                       {"cells", cells_}},
                      push_, gpu::linearGroups(cellCount(push_), 64));
    commands.barrier("light cells");
    commands.dispatch(smoothProgram_, {{"cells", cells_, gpu::Sampler::linear}, {"lightField", image_}}, push_,
                      gpu::linearGroups(cellCount(push_), 64));
}

}  // namespace lumulus::draw
