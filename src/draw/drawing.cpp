#include "draw/drawing.h"

#include "shared/phase_table.h"

namespace lumulus::draw {

namespace {

/// A one-turn table as a picture whose texels are the four corners of a cell (this depth and the next, at this angle
/// and the next), so that one load serves a bilinear look-up: optical depth across, angle down; where colours differ,
/// three texels a cell.
gpu::Image tablePicture(gpu::Context& context, const char* name, const std::vector<float>& table, bool grey) {
    const int channels = grey ? 1 : 3;
    const glm::ivec2 cells =
        table.empty() ? glm::ivec2(1) : glm::ivec2(shared::singleScatterTauCount, shared::singleScatterAngleCount) - 1;
    std::vector<glm::vec4> texels(static_cast<std::size_t>(cells.x * cells.y * channels), glm::vec4(0.0F));
    const auto entry = [&](int angle, int tau, int channel) {
        return table[static_cast<std::size_t>(shared::singleScatterIndex(angle, tau) + channel)];
    };
    for (int i = 0; !table.empty() && i < cells.x * cells.y * channels; ++i) {
        const int channel = i % channels, tau = i / channels % cells.x, angle = i / channels / cells.x;
        texels[static_cast<std::size_t>(i)] = {entry(angle, tau, channel), entry(angle, tau + 1, channel),
                                               entry(angle + 1, tau, channel), entry(angle + 1, tau + 1, channel)};
    }
    gpu::Image image(context, name, {cells.x * channels, cells.y}, VK_FORMAT_R32G32B32A32_SFLOAT);
    gpu::upload(context, image, texels);
    return image;
}

}  // namespace

PhaseTables::PhaseTables(gpu::Context& context, const phase::ScatteringTables& tables, bool grey)
    : phase(gpu::filledBuffer(context, "phase table", tables.phaseTable)),
      before(tablePicture(context, "single scattering H", tables.singleScatterH, grey)),
      after(tablePicture(context, "single scattering K", tables.singleScatterK, grey)) {}

}  // namespace lumulus::draw
