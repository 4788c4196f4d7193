#include "draw/lattice.h"

#include <algorithm>

namespace lumulus::draw {

namespace {

namespace spirv {
#include "spirv/draw/interpolate.comp.h"
}  // namespace spirv

/// Words before the list: workgroups of the drawing in three dimensions, blocks.
constexpr std::uint64_t headerWords = 4;

std::uint64_t countOf(const shared::LatticeParams& lattice) {
    return static_cast<std::uint64_t>(lattice.size.x) * static_cast<std::uint64_t>(lattice.size.y);
}

gpu::Buffer blockList(gpu::Context& context, std::uint64_t blocks) {
    return {context, "blocks", (headerWords + blocks) * sizeof(std::uint32_t), gpu::Memory::host};
}

}  // namespace

int latticeSpacing(double voxelPixels) {
    if (voxelPixels >= 1.5) return widestSpacing;
    return voxelPixels >= 1.0 ? 2 : 1;
}

double drawnShare(int spacing) {
    return spacing == 1 ? 1.0 : 1.0 / (spacing * spacing) + 0.35;
}

shared::LatticeParams latticeOf(const Camera& camera, const Tile& tile, int spacing, double tolerance,
                                double voxelLength) {
    const glm::ivec2 last = (glm::ivec2(camera.width, camera.height) + spacing - 2) / spacing;
    const glm::ivec2 lower = glm::max(glm::ivec2(tile.x, tile.y) / spacing - 1, glm::ivec2(0));
    const glm::ivec2 end(tile.x + tile.width - 1, tile.y + tile.height - 1);
    shared::LatticeParams lattice{};
    lattice.first = lower;
    lattice.size = glm::min(end / spacing + 2, last) - lower + 1;
    lattice.spacing = spacing;
    lattice.tolerance = static_cast<float>(tolerance);
    lattice.depthTolerance = static_cast<float>(8.0 * voxelLength);
    return lattice;
}

Band latticeRows(const shared::LatticeParams& lattice, const Tile& tile, const Band& band) {
    const int top = tile.y + band.first, bottom = top + band.rows - 1;
    const int first = std::max(top / lattice.spacing - 1 - lattice.first.y, 0);
    const int last = std::min(bottom / lattice.spacing + 2 - lattice.first.y, lattice.size.y - 1);
    return {first, last - first + 1};
}

Interpolation::Interpolation(gpu::Context& context)
    : context_(context),
      program_(context, "interpolate", spirv::interpolate_comp),
      points_(context, "lattice", 0, gpu::Memory::device),
      blocks_(noBlocks(context)) {}

void Interpolation::prepare(const shared::LatticeParams& lattice) {
    const std::uint64_t count = countOf(lattice);
    if (count != countOf(lattice_)) {
        points_ = gpu::Buffer(context_, "lattice", count * sizeof(shared::Pixel), gpu::Memory::device);
        blocks_ = blockList(context_, count);
    }
    lattice_ = lattice;
}

void Interpolation::clearBlocks() {
    const auto words = blocks_.mapped<std::uint32_t>();
    words[0] = 0;
    words[1] = words[2] = 1;
    words[3] = 0;
}

void Interpolation::record(gpu::Commands& commands, const FrameInputs& inputs, const shared::DrawPush& push) const {
    const glm::ivec2 blocks = (push.first + push.count - 1) / lattice_.spacing - push.first / lattice_.spacing + 1;
    commands.pass("interpolate");
    commands.dispatch(
        program_, {{"Params", inputs.params}, {"Lattice", points_}, {"Pixels", inputs.pixels}, {"Blocks", blocks_}},
        push, {(static_cast<std::uint32_t>(blocks.x) + 7) / 8, (static_cast<std::uint32_t>(blocks.y) + 7) / 8, 1});
}

gpu::Buffer noBlocks(gpu::Context& context) {
    return blockList(context, 0);
}

}  // namespace lumulus::draw
