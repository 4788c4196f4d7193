#include "draw/frame.h"

#include "shared/phase_table.h"

namespace lumulus::draw {

namespace {

/// A one-turn table as a picture: optical depth across, angle down.
gpu::Image tablePicture(gpu::Context& context, const char* name, const std::vector<float>& table) {
    const bool empty = table.empty();
    const glm::ivec2 extent = empty ? glm::ivec2(1) : glm::ivec2(shared::oneTurnTauCount, shared::oneTurnAngleCount);
    std::vector<glm::vec4> texels(static_cast<std::size_t>(extent.x * extent.y), glm::vec4(0.0F));
    for (std::size_t i = 0; !empty && i < texels.size(); ++i)
        texels[i] = glm::vec4(table[3 * i], table[3 * i + 1], table[3 * i + 2], 0.0F);
    gpu::Image image(context, name, extent, VK_FORMAT_R32G32B32A32_SFLOAT);
    gpu::upload(context, image, texels);
    return image;
}

}  // namespace

PhaseTables::PhaseTables(gpu::Context& context, const phase::ScatteringTables& tables)
    : phase(filledBuffer(context, "phase table", tables.phaseTable)),
      before(tablePicture(context, "one turn H", tables.oneTurnH)),
      after(tablePicture(context, "one turn K", tables.oneTurnK)) {}

}  // namespace lumulus::draw
