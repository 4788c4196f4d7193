#include <cmath>

#include "cloud/prepare_parts.h"
#include "cloud/prepare_programs.h"
#include "gpu/commands.h"
#include "gpu/groups.h"
#include "gpu/transfer.h"

namespace lumulus::cloud {

namespace {

using gpu::linearGroups;
using gpu::Memory;
using gpu::Sampler;

/// Edge of a majorant cell, in blocks.
constexpr int majorantCell = 2;

gpu::Image uploadDensity(gpu::Context& context, const vdb::QuantisedVolume& quantised, const glm::ivec3& size) {
    gpu::Image image(context, "density", size, formatOf(quantised.format));
    gpu::upload(context, image, quantised.texels);
    return image;
}

/// Majorants of the density and bounds of its gradient.
Blocks boundBlocks(gpu::Context& context, const PreparePrograms& programs, const DensityImages& images,
                   const glm::ivec3& size, const glm::mat3& toMetres) {
    Blocks blocks;
    blocks.count = (size + shared::BLOCK_EDGE - 1) / shared::BLOCK_EDGE;
    const auto total = static_cast<std::uint64_t>(blocks.count.x) * static_cast<std::uint64_t>(blocks.count.y) *
                       static_cast<std::uint64_t>(blocks.count.z);
    gpu::Buffer majorants(context, "block majorants", total * sizeof(float), Memory::host);
    gpu::Buffer bounds(context, "gradient bounds", total * sizeof(float), Memory::host);
    const shared::BlockPush push{size, blocks.count, toMetres};
    gpu::Commands commands(context);
    commands.begin();
    commands.pass("majorant");
    commands.dispatch(programs.blockMajorant, {{"density", images.density, Sampler::nearest}, {"Majorants", majorants}},
                      push, linearGroups(total, 64));
    commands.barrier("block majorants");
    commands.pass("gradient");
    commands.dispatch(programs.gradientBound,
                      {{"density", images.density, Sampler::nearest},
                       {"bricks", images.bricks, Sampler::nearest},
                       {"Majorants", majorants},
                       {"Bounds", bounds}},
                      push, linearGroups(total, 64));
    commands.submit();
    commands.wait();
    const auto first = majorants.mapped<float>().subspan(0, total);
    const auto second = bounds.mapped<float>().subspan(0, total);
    blocks.majorants.assign(first.begin(), first.end());
    blocks.gradientBounds.assign(second.begin(), second.end());
    return blocks;
}

/// Voxels up to which a merged grid is given majorants of finer blocks.
constexpr std::uint64_t finerUpTo = 1ULL << 24U;

/// Majorants for cloud::mergeGrids(): of blocks so fine that those that reach over a cell hardly raise its majorant.
MajorantGrid fineBlocks(gpu::Context& context, const PreparePrograms& programs, const DensityImages& images,
                        const glm::ivec3& size) {
    const glm::ivec3 blocks = (size + fineEdge - 1) / fineEdge;
    const auto total = static_cast<std::uint64_t>(blocks.x) * static_cast<std::uint64_t>(blocks.y) *
                       static_cast<std::uint64_t>(blocks.z);
    gpu::Buffer majorants(context, "fine majorants", total * sizeof(float), Memory::host);
    gpu::Commands commands(context);
    commands.begin();
    commands.pass("majorant");
    commands.dispatch(programs.fineMajorant, {{"density", images.density, Sampler::nearest}, {"Majorants", majorants}},
                      shared::BlockPush{size, blocks, {}}, linearGroups(total, 64));
    commands.submit();
    commands.wait();
    const auto found = majorants.mapped<float>().subspan(0, total);
    return {blocks, glm::vec3(static_cast<float>(fineEdge)), {found.begin(), found.end()}};
}

}  // namespace

VkFormat formatOf(vdb::DensityFormat format) {
    switch (format) {
        case vdb::DensityFormat::r8:
            return VK_FORMAT_R8_UNORM;
        case vdb::DensityFormat::r16f:
            return VK_FORMAT_R16_SFLOAT;
        case vdb::DensityFormat::r32f:
            break;
    }
    return VK_FORMAT_R32_SFLOAT;
}

gpu::Image indexCollectors(gpu::Context& context, const gpu::Program<shared::LeafPush>& program, const glm::ivec3& size,
                           const gpu::Buffer& leafBuffer, const std::vector<std::uint32_t>& numbers,
                           std::size_t collectors) {
    gpu::Image index(context, "collector index", size, collectors < 0xFFFF ? VK_FORMAT_R16_UINT : VK_FORMAT_R32_UINT);
    gpu::Buffer numberBuffer(context, "collector of leaf", numbers.size() * sizeof(std::uint32_t), Memory::device);
    gpu::upload(context, numberBuffer, numbers);
    const auto leaves = static_cast<std::uint32_t>(numbers.size());
    gpu::Commands commands(context);
    commands.begin();
    commands.pass("leaf index");
    commands.dispatch(program, {{"Leaves", leafBuffer}, {"Collectors", numberBuffer}, {"collectorIndex", index}},
                      shared::LeafPush{size, leaves}, linearGroups(leaves, 1));
    commands.submit();
    commands.wait();
    return index;
}

Asset prepare(gpu::Context& context, const vdb::PlacedVolume& placed, const PrepareOptions& options) {
    StepWatch watch(options.check);
    PreparationTimes times;
    const PreparePrograms programs(context);
    const vdb::Volume& volume = *placed.volume;
    const glm::dmat3& voxelToMetres = placed.toWorld.linear;
    const vdb::QuantisedVolume quantised = vdb::quantise(volume, options.check);
    auto density = std::make_shared<const gpu::Image>(uploadDensity(context, quantised, volume.size));
    const gpu::Image none(context, "no bricks", glm::ivec3(1), VK_FORMAT_R32_UINT);
    const DensityImages images{*density, none};
    times.upload = watch.lap();
    const glm::mat3 toMetres = gradientToMetres(voxelToMetres);
    const Blocks blocks = boundBlocks(context, programs, images, volume.size, toMetres);
    times.majorants = watch.lap();
    std::vector<Sample> samples =
        sampleGradient(context, programs.sample, images, volume.size, blocks, toMetres, options);
    times.sampling = watch.lap();
    const BlockDensity blockDensity(volume.density, volume.size, volume.maximum, 1, options.check);
    KdTree tree = makeTree(samples, volume.size, blockDensity, voxelToMetres, blocks, options);
    times.tree = watch.lap();

    gpu::Buffer leafBuffer(context, "leaves", tree.leaves.size() * sizeof(shared::LeafBox), Memory::device);
    gpu::upload(context, leafBuffer, tree.leaves);
    const auto statistics = leafStatistics(context, programs.leafStatistics, images, volume.size, leafBuffer,
                                           static_cast<std::uint32_t>(tree.leaves.size()));
    std::vector<std::uint32_t> numbers;
    std::vector<Collector> collectors = makeCollectors(tree, statistics, numbers);
    gpu::Image index =
        indexCollectors(context, programs.leafIndex, volume.size, leafBuffer, numbers, collectors.size());

    times.collectors = watch.lap();

    const double mass = massOf(collectors);
    const MajorantGrid cells = majorantGrid(blocks.majorants, blocks.count, volume.size, majorantCell, mass);
    const MajorantGrid single = majorantGrid(blocks.majorants, blocks.count, volume.size, 0, mass);
    const bool local = isLocal(options.majorant, single);
    const MajorantGrid& grid = local ? cells : single;
    const bool fine = static_cast<std::uint64_t>(quantised.texels.size()) <= finerUpTo;
    MajorantGrid merged;
    if (options.keepBlocks)
        merged = fine ? fineBlocks(context, programs, images, volume.size)
                      : majorantGrid(blocks.majorants, blocks.count, volume.size, 1, mass);
    times.majorants += watch.lap();
    return Asset{volume.size,
                 voxelToMetres,
                 std::abs(glm::determinant(voxelToMetres)),
                 quantised.format,
                 std::move(density),
                 std::nullopt,
                 std::move(index),
                 grid,
                 majorantImage(context, grid),
                 std::move(merged),
                 cells,
                 local ? std::nullopt : std::optional(majorantImage(context, cells)),
                 std::move(samples),
                 std::move(tree),
                 std::move(collectors),
                 times};
}

}  // namespace lumulus::cloud
