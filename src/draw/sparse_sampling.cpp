#include "draw/sparse_sampling.h"

#include <algorithm>

#include "gpu/groups.h"

namespace lumulus::draw {

namespace {

namespace spirv {
#include "spirv/draw/interpolate.comp.h"
#include "spirv/draw/interpolate_refined.comp.h"
}  // namespace spirv

/// Words before the list: workgroups of the drawing in three dimensions, squares.
constexpr std::uint64_t headerWords = 4;

std::uint64_t countOf(const shared::SamplingGrid& sampling) {
    return static_cast<std::uint64_t>(sampling.size.x) * static_cast<std::uint64_t>(sampling.size.y);
}

gpu::Buffer squareList(gpu::Context& context, const char* name, std::uint64_t squares) {
    return {context, name, (headerWords + squares) * sizeof(std::uint32_t), gpu::Memory::host};
}

void clear(const gpu::Buffer& list) {
    const auto words = list.mapped<std::uint32_t>();
    words[0] = 0;
    words[1] = words[2] = 1;
    words[3] = 0;
}

/// Points that a band or a tile needs beyond the block of its last pixel.
int marginOf(int spacing) {
    return hasRefinement(spacing) ? 3 : 2;
}

}  // namespace

int samplingSpacing(double voxelPixels) {
    if (voxelPixels >= 1.5) return widestSpacing;
    return voxelPixels >= 1.0 ? 2 : 1;
}

bool hasRefinement(int spacing) {
    return spacing == widestSpacing;
}

double drawnShare(int spacing) {
    return spacing == 1 ? 1.0 : 1.0 / (spacing * spacing) + 0.35;
}

shared::SamplingGrid samplingGridOf(const Camera& camera, const Tile& tile, int spacing, double tolerance,
                                    double voxelLength) {
    const glm::ivec2 last = (glm::ivec2(camera.width, camera.height) + spacing - 2) / spacing;
    const glm::ivec2 lower = glm::max(glm::ivec2(tile.x, tile.y) / spacing - 1, glm::ivec2(0));
    const glm::ivec2 end(tile.x + tile.width - 1, tile.y + tile.height - 1);
    shared::SamplingGrid sampling{};
    sampling.first = lower;
    sampling.size = glm::min(end / spacing + marginOf(spacing), last) - lower + 1;
    sampling.spacing = spacing;
    sampling.tolerance = static_cast<float>(tolerance);
    sampling.depthTolerance = static_cast<float>(8.0 * voxelLength);
    return sampling;
}

Band samplingRows(const shared::SamplingGrid& sampling, const Tile& tile, const Band& band) {
    const int top = tile.y + band.first, bottom = top + band.rows - 1;
    const int first = std::max(top / sampling.spacing - 1 - sampling.first.y, 0);
    const int last =
        std::min(bottom / sampling.spacing + marginOf(sampling.spacing) - sampling.first.y, sampling.size.y - 1);
    return {first, last - first + 1};
}

Interpolation::Interpolation(gpu::Context& context, int spacing, bool many)
    : context_(context),
      spacing_(spacing),
      program_(context, "interpolate", spirv::interpolate_comp,
               {gpu::SpecConstant::of(0, hasRefinement(spacing)), gpu::SpecConstant::of(4, many)}),
      points_(pixelBuffer(context, "sample points", 0)),
      refined_(pixelBuffer(context, "refined", 0)),
      blocks_(squareList(context, "blocks", 0)),
      cells_(squareList(context, "cells", 0)) {
    if (hasRefinement(spacing))
        refinedProgram_.emplace(context, "interpolate_refined", spirv::interpolate_refined_comp,
                                std::vector{gpu::SpecConstant::of(4, many)});
}

void Interpolation::prepare(const shared::SamplingGrid& sampling, int bandRows) {
    const std::uint64_t inBand =
        static_cast<std::uint64_t>(sampling.size.x) * static_cast<std::uint64_t>(bandRows / sampling.spacing + 2);
    if (points_.bytes() < countOf(sampling) * sizeof(shared::Pixel))
        points_ = pixelBuffer(context_, "sample points", countOf(sampling));
    if (blocksInBand_ < inBand) {
        blocksInBand_ = inBand;
        blocks_ = squareList(context_, "blocks", inBand);
        if (hasRefinement(spacing_)) {
            refined_ = pixelBuffer(context_, "refined", 4 * inBand);
            cells_ = squareList(context_, "cells", 4 * inBand);
        }
    }
    sampling_ = sampling;
}

void Interpolation::clearLists() {
    clear(blocks_);
    clear(cells_);
}

shared::InterpolatePush Interpolation::push(const Tile& pixels) const {
    const glm::ivec2 first(pixels.x, pixels.y), count(pixels.width, pixels.height);
    const glm::ivec2 firstBlock = first / sampling_.spacing;
    const int beside = hasRefinement(spacing_) ? 1 : 0;
    const glm::ivec2 last =
        glm::min((first + count - 1) / sampling_.spacing + beside, sampling_.first + sampling_.size - 1);
    return {first, count, firstBlock, last - firstBlock + 1};
}

shared::DrawPush Interpolation::refinedPoints(const Tile& pixels) const {
    const shared::InterpolatePush all = push(pixels);
    return {shared::DRAW_REFINED, 2 * all.firstBlock, 2 * all.blocks};
}

shared::DrawPush Interpolation::squares(const Tile& pixels) const {
    return {shared::DRAW_SQUARES, {pixels.x, pixels.y}, {pixels.width, pixels.height}};
}

void Interpolation::record(gpu::Commands& commands, const DrawInputs& inputs, const InstanceTiles& tiles,
                           const Tile& pixels) const {
    const shared::InterpolatePush values = push(pixels);
    commands.pass("interpolate");
    commands.dispatch(
        program_,
        {{"Params", inputs.params},
         {"samplePoints", points_},
         {"Pixels", inputs.pixels},
         {"Blocks", blocks_},
         {"Refined", refined_},
         {"TileDetail", tiles.detail()}},
        values,
        gpu::linearGroups(static_cast<std::uint64_t>(values.blocks.x) * static_cast<std::uint64_t>(values.blocks.y),
                          64));
}

void Interpolation::recordRefined(gpu::Commands& commands, const DrawInputs& inputs, const InstanceTiles& tiles,
                                  const Tile& pixels) const {
    commands.pass("interpolate refined");
    commands.dispatchIndirect(*refinedProgram_,
                              {{"Params", inputs.params},
                               {"refined", refined_},
                               {"Pixels", inputs.pixels},
                               {"Blocks", blocks_},
                               {"Cells", cells_},
                               {"TileDetail", tiles.detail()}},
                              push(pixels), blocks_);
}

gpu::Buffer noSquares(gpu::Context& context) {
    return squareList(context, "squares", 0);
}

}  // namespace lumulus::draw
