#include "draw/drawing.h"

#include <algorithm>

#include "shared/phase_table.h"

namespace lumulus::draw {

namespace {

/// The single-scattering tables of all media as one picture, one below the other. Its texels are the four corners of a
/// cell (this depth and the next, at this angle and the next), so that one load serves a bilinear look-up: optical
/// depth across, angle down; where colours differ, three texels a cell. Media without a table have zeros.
gpu::Image tablePicture(gpu::Context& context, const char* name, std::span<const std::vector<float>* const> tables,
                        bool grey) {
    const int channels = grey ? 1 : 3;
    const bool none = std::ranges::all_of(tables, [](const auto* table) { return table->empty(); });
    const glm::ivec2 cells =
        none ? glm::ivec2(1) : glm::ivec2(shared::singleScatterTauCount, shared::singleScatterAngleCount) - 1;
    const auto each = static_cast<std::size_t>(cells.x * cells.y * channels);
    std::vector<glm::vec4> texels(each * tables.size(), glm::vec4(0.0F));
    for (std::size_t medium = 0; medium < tables.size(); ++medium) {
        const std::vector<float>& table = *tables[medium];
        const auto entry = [&](int angle, int tau, int channel) {
            return table[static_cast<std::size_t>(shared::singleScatterIndex(angle, tau) + channel)];
        };
        for (std::size_t k = 0; !table.empty() && k < each; ++k) {
            const int i = static_cast<int>(k), channel = i % channels, tau = i / channels % cells.x,
                      angle = i / channels / cells.x;
            texels[medium * each + k] = {entry(angle, tau, channel), entry(angle, tau + 1, channel),
                                         entry(angle + 1, tau, channel), entry(angle + 1, tau + 1, channel)};
        }
    }
    gpu::Image image(context, name, {cells.x * channels, cells.y * static_cast<int>(tables.size())},
                     VK_FORMAT_R32G32B32A32_SFLOAT);
    gpu::upload(context, image, texels);
    return image;
}

template <class Member>
std::vector<const std::vector<float>*> each(std::span<const phase::ScatteringTables* const> media, Member member) {
    std::vector<const std::vector<float>*> tables;
    for (const phase::ScatteringTables* medium : media) tables.push_back(&(medium->*member).values());
    return tables;
}

/// The phase functions of all media; three values an entry for each where those of some differ between colours.
std::vector<float> phaseTables(std::span<const phase::ScatteringTables* const> media, bool coloured) {
    std::vector<float> all;
    for (const phase::ScatteringTables* medium : media) {
        const std::size_t copies = coloured && !medium->coloured ? 3 : 1;
        for (const float value : medium->phaseTable) all.insert(all.end(), copies, value);
    }
    return all;
}

}  // namespace

PhaseTables::PhaseTables(gpu::Context& context, std::span<const phase::ScatteringTables* const> media,
                         const DrawFeatures& how)
    : phase(gpu::filledBuffer(context, "phase table", phaseTables(media, how.coloured))),
      before(tablePicture(context, "single scattering H", each(media, &phase::ScatteringTables::singleScatterH),
                          how.grey)),
      after(tablePicture(context, "single scattering K", each(media, &phase::ScatteringTables::singleScatterK),
                         how.grey)) {}

}  // namespace lumulus::draw
