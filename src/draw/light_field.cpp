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

/// Cells along the longest side with 200,000 photons, and their number with the cube root of that of the photons: as
/// fine as the light changes near the surface, as coarse as the noise asks (docs/error-time.md has the figures).
constexpr double cellsAlong = 48.0, photonsThen = 2e5;
/// 64 MiB each for the cells and for the smoothed field.
constexpr std::uint64_t maxCells = 1ULL << 22U;

std::uint64_t cellCount(const shared::LightFieldPush& push) {
    return static_cast<std::uint64_t>(push.grid.x) * static_cast<std::uint64_t>(push.grid.y) *
           static_cast<std::uint64_t>(push.grid.z);
}

shared::LightFieldPush gridFor(const glm::ivec3& size, std::uint64_t photons) {
    shared::LightFieldPush push{};
    const int longest = std::max(size.x, std::max(size.y, size.z));
    const double along = cellsAlong * std::cbrt(static_cast<double>(photons) / photonsThen);
    push.size = size;
    push.edge = std::max(1, static_cast<int>(std::lround(longest / along)));
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
      push_(gridFor(cloud.size, photons)),
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
