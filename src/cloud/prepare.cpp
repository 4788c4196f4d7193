#include <chrono>
#include <cmath>
#include <glm/gtc/matrix_inverse.hpp>

#include "base/interrupt.h"
#include "cloud/asset.h"
#include "gpu/commands.h"
#include "gpu/groups.h"
#include "gpu/transfer.h"

namespace lumulus::cloud {

namespace {

namespace spirv {
#include "spirv/cloud/block_majorant.comp.h"
#include "spirv/cloud/gradient_bound.comp.h"
#include "spirv/cloud/leaf_index.comp.h"
#include "spirv/cloud/leaf_statistics.comp.h"
#include "spirv/cloud/sample.comp.h"
}  // namespace spirv

using gpu::linearGroups;
using gpu::Memory;
using gpu::Sampler;

/// A global majorant wins where fewer null collisions than this fall on a real one: a cell step costs about as much as
/// a collision (docs/numbers.md).
constexpr double globalMajorantLimit = 4.0;
/// Edge of a majorant cell, in blocks.
constexpr int majorantCell = 2;

/// Times the steps of the preparation, and lets Ctrl-C end it between two of them.
class Stopwatch {
  public:
    double lap() {
        stopIfInterrupted();
        const auto now = std::chrono::steady_clock::now();
        const double seconds = std::chrono::duration<double>(now - start_).count();
        start_ = now;
        return seconds;
    }

  private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

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

gpu::Image uploadDensity(gpu::Context& context, const vdb::QuantisedVolume& quantised, const glm::ivec3& size) {
    gpu::Image image(context, "density", size, formatOf(quantised.format));
    gpu::upload(context, image, quantised.texels);
    return image;
}

glm::mat3 gradientToMetres(const glm::dmat3& voxelToMetres) {
    return glm::mat3(glm::inverseTranspose(voxelToMetres));
}

glm::dvec3 voxelEdges(const glm::dmat3& voxelToMetres) {
    return {glm::length(voxelToMetres[0]), glm::length(voxelToMetres[1]), glm::length(voxelToMetres[2])};
}

/// What the block passes find: majorants of the density and bounds of its gradient.
struct Blocks {
    glm::ivec3 count;
    std::vector<float> majorants;
    std::vector<float> gradientBounds;
};

Blocks boundBlocks(gpu::Context& context, const gpu::Image& density, const glm::ivec3& size,
                   const glm::mat3& toMetres) {
    const gpu::Program<shared::BlockPush> majorant(context, "block_majorant", spirv::block_majorant_comp);
    const gpu::Program<shared::BlockPush> bound(context, "gradient_bound", spirv::gradient_bound_comp);
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
    commands.dispatch(majorant, {{"density", density, Sampler::nearest}, {"Majorants", majorants}}, push,
                      linearGroups(total, 64));
    commands.barrier("block majorants");
    commands.pass("gradient");
    commands.dispatch(bound, {{"density", density, Sampler::nearest}, {"Majorants", majorants}, {"Bounds", bounds}},
                      push, linearGroups(total, 64));
    commands.submit();
    commands.wait();
    const auto first = majorants.mapped<float>().subspan(0, total);
    const auto second = bounds.mapped<float>().subspan(0, total);
    blocks.majorants.assign(first.begin(), first.end());
    blocks.gradientBounds.assign(second.begin(), second.end());
    return blocks;
}

/// Shares of 2³² up to and with each block, from sums in double; empty where the gradient is zero everywhere.
std::vector<std::uint32_t> cumulativeShares(const std::vector<float>& bounds) {
    double total = 0.0;
    for (const float bound : bounds) total += static_cast<double>(bound);
    if (!(total > 0.0)) return {};
    std::vector<std::uint32_t> shares(bounds.size());
    double sum = 0.0;
    for (std::size_t i = 0; i < bounds.size(); ++i) {
        sum += static_cast<double>(bounds[i]);
        shares[i] = static_cast<std::uint32_t>(std::min(sum / total, 1.0) * 4294967295.0);
    }
    return shares;
}

std::vector<Sample> sampleGradient(gpu::Context& context, const gpu::Image& density, const glm::ivec3& size,
                                   const Blocks& blocks, const glm::mat3& toMetres, const PrepareOptions& options) {
    const std::vector<std::uint32_t> shares = cumulativeShares(blocks.gradientBounds);
    if (shares.empty()) return {};
    const gpu::Program<shared::SamplePush> program(context, "sample", spirv::sample_comp);
    gpu::Buffer bounds(context, "gradient bounds", shares.size() * sizeof(float), Memory::device);
    gpu::Buffer cumulative(context, "gradient prefix", shares.size() * sizeof(std::uint32_t), Memory::device);
    gpu::upload(context, bounds, blocks.gradientBounds);
    gpu::upload(context, cumulative, shares);
    const auto count = static_cast<std::uint32_t>(options.preparation.samples);
    gpu::Buffer samples(context, "samples", count * sizeof(glm::vec4), Memory::host);
    gpu::Commands commands(context);
    commands.begin();
    commands.pass("sample");
    commands.dispatch(
        program,
        {{"density", density, Sampler::linear}, {"Bounds", bounds}, {"Cumulative", cumulative}, {"Samples", samples}},
        shared::SamplePush{toMetres, size, blocks.count, count, options.seed}, linearGroups(count, 64));
    commands.submit();
    commands.wait();
    std::vector<Sample> result(count);
    const auto values = samples.mapped<glm::vec4>();
    for (std::size_t i = 0; i < count; ++i) result[i] = {glm::vec3(values[i]), values[i].w};
    return result;
}

/// Mean distance between samples if they filled the occupied blocks evenly, in metres; half as much again as radius.
double automaticInfluence(const Blocks& blocks, std::size_t samples, double voxelVolume) {
    std::size_t occupied = 0;
    for (const float majorant : blocks.majorants) occupied += majorant > 0.0F ? 1 : 0;
    const double volume = static_cast<double>(occupied) * std::pow(shared::BLOCK_EDGE, 3) * voxelVolume;
    return 1.5 * std::cbrt(volume / static_cast<double>(std::max<std::size_t>(samples, 1)));
}

std::vector<shared::LeafStatistics> leafStatistics(gpu::Context& context, const gpu::Image& density,
                                                   const glm::ivec3& size, const gpu::Buffer& leafBuffer,
                                                   std::uint32_t leaves) {
    const gpu::Program<shared::LeafPush> program(context, "leaf_statistics", spirv::leaf_statistics_comp);
    gpu::Buffer statistics(context, "leaf statistics", leaves * sizeof(shared::LeafStatistics), Memory::host);
    gpu::Commands commands(context);
    commands.begin();
    commands.pass("leaves");
    commands.dispatch(program,
                      {{"density", density, Sampler::linear}, {"Leaves", leafBuffer}, {"Statistics", statistics}},
                      shared::LeafPush{size, leaves}, linearGroups(leaves, 1));
    commands.submit();
    commands.wait();
    const auto values = statistics.mapped<shared::LeafStatistics>().subspan(0, leaves);
    return {values.begin(), values.end()};
}

/// One collector for each leaf that has mass; `numbers` receives the collector of each leaf.
std::vector<Collector> makeCollectors(const KdTree& tree, const std::vector<shared::LeafStatistics>& statistics,
                                      std::vector<std::uint32_t>& numbers) {
    std::vector<Collector> collectors;
    numbers.assign(tree.leaves.size(), 0xFFFFFFFFU);
    for (std::size_t leaf = 0; leaf < tree.leaves.size(); ++leaf) {
        const shared::LeafStatistics& found = statistics[leaf];
        if (!(found.mass > 0.0F)) continue;
        numbers[leaf] = static_cast<std::uint32_t>(collectors.size());
        collectors.push_back({glm::vec3(tree.leaves[leaf].lower) + found.moment / found.mass, found.mass,
                              found.majorant, found.occupied, tree.leaves[leaf]});
    }
    return collectors;
}

gpu::Image indexCollectors(gpu::Context& context, const glm::ivec3& size, const gpu::Buffer& leafBuffer,
                           const std::vector<std::uint32_t>& numbers, std::size_t collectors) {
    const gpu::Program<shared::LeafPush> program(context, "leaf_index", spirv::leaf_index_comp);
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

gpu::Image majorantImage(gpu::Context& context, const MajorantGrid& grid) {
    gpu::Image image(context, "majorants", grid.cells, VK_FORMAT_R32_SFLOAT);
    gpu::upload(context, image, majorantsAndDistances(grid));
    return image;
}

KdTree makeTree(const std::vector<Sample>& samples, const vdb::Volume& volume, const glm::dmat3& voxelToMetres,
                const Blocks& blocks, const PrepareOptions& options, double voxelVolume) {
    const BlockDensity blockDensity(volume.density, volume.size, volume.maximum);
    KdTreeOptions tree;
    tree.densityThreshold = options.preparation.densityThreshold;
    tree.voxelEdge = voxelEdges(voxelToMetres);
    tree.influenceRadius =
        options.preparation.influenceRadius.value_or(automaticInfluence(blocks, samples.size(), voxelVolume)) /
        tree.voxelEdge;
    tree.maxLeaves = options.preparation.maxLeaves;
    tree.reducedExtinction = options.reducedExtinction;
    tree.density = &blockDensity;
    return buildKdTree(samples, volume.size, tree);
}

}  // namespace

Asset prepare(gpu::Context& context, const vdb::PlacedVolume& placed, const PrepareOptions& options) {
    Stopwatch watch;
    PreparationTimes times;
    const vdb::Volume& volume = *placed.volume;
    const glm::dmat3& voxelToMetres = placed.toWorld.linear;
    const double voxelVolume = std::abs(glm::determinant(voxelToMetres));
    const vdb::QuantisedVolume quantised = vdb::quantise(volume);
    gpu::Image density = uploadDensity(context, quantised, volume.size);
    times.upload = watch.lap();
    const glm::mat3 toMetres = gradientToMetres(voxelToMetres);
    const Blocks blocks = boundBlocks(context, density, volume.size, toMetres);
    times.gradient = watch.lap();
    std::vector<Sample> samples = sampleGradient(context, density, volume.size, blocks, toMetres, options);
    times.sampling = watch.lap();
    KdTree tree = makeTree(samples, volume, voxelToMetres, blocks, options, voxelVolume);
    times.tree = watch.lap();

    gpu::Buffer leafBuffer(context, "leaves", tree.leaves.size() * sizeof(shared::LeafBox), Memory::device);
    gpu::upload(context, leafBuffer, tree.leaves);
    const auto statistics =
        leafStatistics(context, density, volume.size, leafBuffer, static_cast<std::uint32_t>(tree.leaves.size()));
    std::vector<std::uint32_t> numbers;
    std::vector<Collector> collectors = makeCollectors(tree, statistics, numbers);
    gpu::Image index = indexCollectors(context, volume.size, leafBuffer, numbers, collectors.size());

    double mass = 0.0;
    for (const Collector& collector : collectors) mass += static_cast<double>(collector.mass);
    const MajorantGrid cells = majorantGrid(blocks.majorants, blocks.count, volume.size, majorantCell, mass);
    const MajorantGrid single = majorantGrid(blocks.majorants, blocks.count, volume.size, 0, mass);
    const bool local = options.majorant == scene::Majorant::local ||
                       (options.majorant == scene::Majorant::automatic && single.nullCollisions >= globalMajorantLimit);
    const MajorantGrid& grid = local ? cells : single;
    times.leaves = watch.lap();
    return Asset{
        volume.size,
        voxelToMetres,
        voxelVolume,
        quantised.format,
        std::move(density),
        std::move(index),
        grid,
        majorantImage(context, grid),
        options.keepBlocks ? majorantGrid(blocks.majorants, blocks.count, volume.size, 1, mass) : MajorantGrid{},
        cells,
        local ? std::nullopt : std::optional(majorantImage(context, cells)),
        std::move(samples),
        std::move(tree),
        std::move(collectors),
        times};
}

}  // namespace lumulus::cloud
