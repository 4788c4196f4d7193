#include "cloud/prepare_parts.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_inverse.hpp>

#include "gpu/commands.h"
#include "gpu/groups.h"
#include "gpu/transfer.h"
#include "shared/photon.h"

namespace lumulus::cloud {

namespace {

using gpu::linearGroups;
using gpu::Memory;
using gpu::Sampler;

/// A global majorant wins where fewer null collisions than this fall on a real one: a cell step costs about as much as
/// a collision (docs/numbers.md).
constexpr double globalMajorantLimit = 4.0;

glm::dvec3 voxelEdges(const glm::dmat3& voxelToMetres) {
    return {glm::length(voxelToMetres[0]), glm::length(voxelToMetres[1]), glm::length(voxelToMetres[2])};
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

/// Mean distance between samples if they filled the occupied blocks evenly, in metres; half as much again as radius.
double automaticInfluence(const Blocks& blocks, std::size_t samples, double voxelVolume) {
    const double volume = blocks.occupiedVoxels() * voxelVolume;
    return 1.5 * std::cbrt(volume / static_cast<double>(std::max<std::size_t>(samples, 1)));
}

}  // namespace

glm::mat3 gradientToMetres(const glm::dmat3& voxelToMetres) {
    return glm::mat3(glm::inverseTranspose(voxelToMetres));
}

double Blocks::occupiedVoxels() const {
    const auto occupied = std::ranges::count_if(majorants, [](float majorant) { return majorant > 0.0F; });
    return static_cast<double>(occupied) * std::pow(edge, 3);
}

std::vector<Sample> sampleGradient(gpu::Context& context, const gpu::Program<shared::SamplePush>& program,
                                   const DensityImages& images, const glm::ivec3& size, const Blocks& blocks,
                                   const glm::mat3& toMetres, const PrepareOptions& options) {
    const std::vector<std::uint32_t> shares = cumulativeShares(blocks.gradientBounds);
    if (shares.empty()) return {};
    const gpu::Buffer places = gpu::filledBuffer(context, "block places", blocks.places);
    gpu::Buffer bounds(context, "gradient bounds", shares.size() * sizeof(float), Memory::device);
    gpu::Buffer cumulative(context, "gradient prefix", shares.size() * sizeof(std::uint32_t), Memory::device);
    gpu::upload(context, bounds, blocks.gradientBounds);
    gpu::upload(context, cumulative, shares);
    const auto count = static_cast<std::uint32_t>(options.preparation.samples);
    gpu::Buffer samples(context, "samples", count * sizeof(glm::vec4), Memory::host);
    gpu::Commands commands(context);
    commands.begin();
    commands.pass("sample");
    commands.dispatch(program,
                      {{"density", images.density, Sampler::linear},
                       {"bricks", images.bricks, Sampler::nearest},
                       {"Bounds", bounds},
                       {"Cumulative", cumulative},
                       {"Samples", samples},
                       {"Places", places}},
                      shared::SamplePush{toMetres, size, blocks.count, count, options.seed}, linearGroups(count, 64));
    commands.submit();
    commands.wait();
    std::vector<Sample> result(count);
    const auto values = samples.mapped<glm::vec4>();
    for (std::size_t i = 0; i < count; ++i) result[i] = {glm::vec3(values[i]), values[i].w};
    return result;
}

KdTree makeTree(const std::vector<Sample>& samples, const glm::ivec3& size, const BlockDensity& density,
                const glm::dmat3& voxelToMetres, const Blocks& blocks, const PrepareOptions& options) {
    const double voxelVolume = std::abs(glm::determinant(voxelToMetres));
    KdTreeOptions tree;
    tree.densityThreshold = options.preparation.densityThreshold;
    tree.voxelEdge = voxelEdges(voxelToMetres);
    tree.influenceRadius =
        options.preparation.influenceRadius.value_or(automaticInfluence(blocks, samples.size(), voxelVolume)) /
        tree.voxelEdge;
    tree.maxLeaves = options.preparation.maxLeaves;
    tree.reducedExtinction = options.reducedExtinction;
    tree.density = &density;
    tree.check = options.check;
    return buildKdTree(samples, size, tree);
}

std::vector<shared::LeafStatistics> leafStatistics(gpu::Context& context, const gpu::Program<shared::LeafPush>& program,
                                                   const DensityImages& images, const glm::ivec3& size,
                                                   const gpu::Buffer& leafBuffer, std::uint32_t leaves) {
    gpu::Buffer statistics(context, "leaf statistics", leaves * sizeof(shared::LeafStatistics), Memory::host);
    gpu::Commands commands(context);
    commands.begin();
    commands.pass("leaves");
    commands.dispatch(program,
                      {{"density", images.density, Sampler::linear},
                       {"bricks", images.bricks, Sampler::nearest},
                       {"Leaves", leafBuffer},
                       {"Statistics", statistics}},
                      shared::LeafPush{size, leaves}, linearGroups(leaves, 1));
    commands.submit();
    commands.wait();
    const auto values = statistics.mapped<shared::LeafStatistics>().subspan(0, leaves);
    return {values.begin(), values.end()};
}

std::vector<Collector> makeCollectors(const KdTree& tree, const std::vector<shared::LeafStatistics>& statistics,
                                      std::vector<std::uint32_t>& numbers) {
    std::vector<Collector> collectors;
    numbers.assign(tree.leaves.size(), shared::NO_COLLECTOR);
    for (std::size_t leaf = 0; leaf < tree.leaves.size(); ++leaf) {
        const shared::LeafStatistics& found = statistics[leaf];
        if (!(found.mass > 0.0F)) continue;
        numbers[leaf] = static_cast<std::uint32_t>(collectors.size());
        collectors.push_back({glm::vec3(tree.leaves[leaf].lower) + found.moment / found.mass, found.mass,
                              found.majorant, found.occupied, tree.leaves[leaf]});
    }
    return collectors;
}

double massOf(const std::vector<Collector>& collectors) {
    double mass = 0.0;
    for (const Collector& collector : collectors) mass += static_cast<double>(collector.mass);
    return mass;
}

bool isLocal(scene::Majorant wanted, const MajorantGrid& single) {
    return wanted == scene::Majorant::local ||
           (wanted == scene::Majorant::automatic && single.nullCollisions >= globalMajorantLimit);
}

gpu::Image majorantImage(gpu::Context& context, const MajorantGrid& grid) {
    gpu::Image image(context, "majorants", grid.cells, VK_FORMAT_R32_SFLOAT);
    gpu::upload(context, image, majorantsAndDistances(grid));
    return image;
}

}  // namespace lumulus::cloud
