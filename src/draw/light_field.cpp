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

/// Cells along the longest side: as fine as the light changes and as coarse as the noise of a few million photons asks.
constexpr double cellsAlong = 48.0;

shared::LightFieldPush gridFor(const glm::ivec3& size) {
    shared::LightFieldPush push{};
    const int longest = std::max(size.x, std::max(size.y, size.z));
    push.size = size;
    push.edge = std::max(1, static_cast<int>(std::lround(longest / cellsAlong)));
    push.grid = (size + push.edge - 1) / push.edge;
    return push;
}

std::uint64_t cellCount(const shared::LightFieldPush& push) {
    return static_cast<std::uint64_t>(push.grid.x) * static_cast<std::uint64_t>(push.grid.y) *
           static_cast<std::uint64_t>(push.grid.z);
}

}  // namespace

LightField::LightField(gpu::Context& context, const cloud::Cloud& cloud)
    : cloud_(cloud),
      push_(gridFor(cloud.size)),
      cellsProgram_(context, "light_cells", spirv::light_cells_comp),
      smoothProgram_(context, "light_smooth", spirv::light_smooth_comp),
      cells_(context, "light cells", cellCount(push_) * sizeof(glm::vec4), gpu::Memory::device),
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
                       {"Cells", cells_}},
                      push_, gpu::linearGroups(cellCount(push_), 64));
    commands.barrier("light cells");
    commands.dispatch(smoothProgram_, {{"Cells", cells_}, {"lightField", image_}}, push_,
                      gpu::linearGroups(cellCount(push_), 64));
}

}  // namespace lumulus::draw
