#include "draw/frame.h"

#include "shared/phase_table.h"

namespace lumulus::draw {

namespace {

/// A one-turn table as a picture: optical depth across, angle down; one channel where all three are the same.
gpu::Image tablePicture(gpu::Context& context, const char* name, const std::vector<float>& table, bool grey) {
    const bool empty = table.empty();
    const glm::ivec2 extent = empty ? glm::ivec2(1) : glm::ivec2(shared::oneTurnTauCount, shared::oneTurnAngleCount);
    const std::size_t channels = grey ? 1 : 4;
    std::vector<float> texels(static_cast<std::size_t>(extent.x * extent.y) * channels, 0.0F);
    for (std::size_t i = 0; !empty && i < texels.size(); ++i)
        if (i % channels < 3) texels[i] = table[3 * (i / channels) + i % channels];
    gpu::Image image(context, name, extent, grey ? VK_FORMAT_R32_SFLOAT : VK_FORMAT_R32G32B32A32_SFLOAT);
    gpu::upload(context, image, texels);
    return image;
}

}  // namespace

PhaseTables::PhaseTables(gpu::Context& context, const phase::ScatteringTables& tables, bool grey)
    : phase(filledBuffer(context, "phase table", tables.phaseTable)),
      before(tablePicture(context, "one turn H", tables.oneTurnH, grey)),
      after(tablePicture(context, "one turn K", tables.oneTurnK, grey)) {}

}  // namespace lumulus::draw
