#include <algorithm>
#include <cmath>

#include "cloud/bricks.h"
#include "cloud/prepare_parts.h"
#include "gpu/transfer.h"
#include "shared/photon.h"

namespace lumulus::cloud {

namespace {

namespace spirv {
#include "spirv/cloud/leaf_statistics_bricks.comp.h"
#include "spirv/cloud/sample.comp.h"
}  // namespace spirv

using vdb::SparseVolume;

/// Values of the coarse density by which the kD-tree is split.
constexpr double mostValues = 4.0e6;
/// A leaf of the kD-tree in the collector index: an axis that no inner node has.
constexpr std::uint32_t leafNode = 3U << 30U;

/// Mean density of cubes of `scale` voxels, a whole number of bricks along each edge.
struct CoarseDensity {
    int scale = SparseVolume::brickEdge;
    glm::ivec3 size{0};
    std::vector<float> values;
};

CoarseDensity coarseDensity(const SparseVolume& volume) {
    CoarseDensity coarse;
    const auto fit = [&] { coarse.size = (volume.size + coarse.scale - 1) / coarse.scale; };
    for (fit(); static_cast<double>(coarse.size.x) * coarse.size.y * coarse.size.z > mostValues; fit())
        coarse.scale *= 2;
    coarse.values.assign(static_cast<std::size_t>(coarse.size.x) * static_cast<std::size_t>(coarse.size.y) *
                             static_cast<std::size_t>(coarse.size.z),
                         0.0F);
    const auto voxels = static_cast<float>(std::pow(coarse.scale, 3));
    for (const vdb::LeafTable::Leaf& leaf : volume.leaves.leaves) {
        const glm::ivec3 at = SparseVolume::brickEdge * leaf.at / coarse.scale;
        coarse.values[static_cast<std::size_t>(at.x) +
                      static_cast<std::size_t>(coarse.size.x) *
                          (static_cast<std::size_t>(at.y) + static_cast<std::size_t>(coarse.size.y) *
                                                                static_cast<std::size_t>(at.z))] += leaf.mass / voxels;
    }
    return coarse;
}

/// A bound of |∇ρ| in a brick: no value around it differs from another by more than those of the leaves there.
float gradientBound(const SparseVolume& volume, const glm::ivec3& brick, const glm::mat3& toMetres) {
    float least = 1.0F, most = 0.0F;
    for (int i = 0; i < 27; ++i) {
        const vdb::LeafTable::Leaf* leaf = volume.leafAt(brick + glm::ivec3(i % 3, i / 3 % 3, i / 9) - 1);
        least = std::min(least, leaf == nullptr ? 0.0F : leaf->least / volume.maximum);
        most = std::max(most, leaf == nullptr ? 0.0F : leaf->most / volume.maximum);
    }
    // what is stored differs from the values by a step of the texels at most
    const float difference = 0.5F * (most - least) + (most > least ? most / 255.0F : 0.0F);
    return difference * (glm::length(toMetres[0]) + glm::length(toMetres[1]) + glm::length(toMetres[2]));
}

/// The bricks with density and those around them.
Blocks brickBlocks(const SparseVolume& volume, const glm::mat3& toMetres, const Check& check) {
    Blocks blocks;
    blocks.edge = SparseVolume::brickEdge;
    for (const vdb::LeafTable::Leaf& leaf : volume.leaves.leaves) {
        // each brick once: that of a leaf, or one without a leaf by the first leaf around it
        for (int i = 0; i < 27; ++i) {
            const glm::ivec3 at = leaf.at + glm::ivec3(i % 3, i / 3 % 3, i / 9) - 1;
            if (glm::any(glm::lessThan(at, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(at, volume.bricks())))
                continue;
            if (i != 13 && volume.leafAt(at) != nullptr) continue;
            bool first = true;
            for (int k = 0; k < 27 && i != 13 && first; ++k) {
                const vdb::LeafTable::Leaf* other = volume.leafAt(at + glm::ivec3(k % 3, k / 3 % 3, k / 9) - 1);
                first = other == nullptr || other >= &leaf;
            }
            if (!first) continue;
            blocks.places.push_back(at);
            blocks.majorants.push_back(i == 13 ? leaf.most / volume.maximum : 0.0F);
            blocks.gradientBounds.push_back(gradientBound(volume, at, toMetres));
        }
        if ((&leaf - volume.leaves.leaves.data()) % 65536 == 0) check();
    }
    blocks.count = {static_cast<int>(blocks.places.size()), 1, 1};
    return blocks;
}

/// The node of the tree that holds a brick, as deep as possible.
int nodeOf(const KdTree& tree, const glm::ivec3& brick) {
    const glm::ivec3 lower = SparseVolume::brickEdge * brick, upper = lower + SparseVolume::brickEdge;
    int at = 0;
    for (;;) {
        const KdNode& node = tree.nodes[static_cast<std::size_t>(at)];
        if (node.axis < 0) return at;
        if (upper[node.axis] <= node.plane)
            at = node.child[0];
        else if (lower[node.axis] >= node.plane)
            at = node.child[1];
        else
            return at;
    }
}

/// Nodes for the entries of the bricks, then all of the tree (lib/collector.glsl).
gpu::Image indexCollectors(gpu::Context& context, const SparseVolume& volume, const KdTree& tree,
                           const std::vector<std::uint32_t>& numbers) {
    const auto nodes = static_cast<std::uint32_t>(volume.nodes.size() + volume.entries.size());
    const auto texelOf = [&](int number) {
        const KdNode& node = tree.nodes[static_cast<std::size_t>(number)];
        if (node.axis < 0) return glm::uvec2(leafNode, numbers[static_cast<std::size_t>(node.leaf)]);
        return glm::uvec2(static_cast<std::uint32_t>(node.axis) << 30U | static_cast<std::uint32_t>(node.plane),
                          nodes + static_cast<std::uint32_t>(node.child[0]));
    };
    std::vector<glm::uvec2> texels(nodes, glm::uvec2(leafNode, shared::NO_COLLECTOR));
    const glm::ivec3 bricks = volume.bricks();
    std::size_t root = 0;
    for (int z = 0; z < volume.roots.z; ++z)
        for (int y = 0; y < volume.roots.y; ++y)
            for (int x = 0; x < volume.roots.x; ++x, ++root) {
                if (volume.nodes[root] == 0) continue;
                for (int i = 0; i < SparseVolume::nodeEntries; ++i) {
                    const glm::ivec3 brick =
                        SparseVolume::nodeEdge * glm::ivec3(x, y, z) + glm::ivec3(i % 4, i / 4 % 4, i / 16);
                    if (glm::any(glm::greaterThanEqual(brick, bricks))) continue;
                    const std::size_t entry = volume.entryOf(brick);
                    texels[volume.nodes.size() + entry] = texelOf(nodeOf(tree, brick));
                }
            }
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) texels.push_back(texelOf(static_cast<int>(i)));
    return makeIndexImage(context, "collector index", std::move(texels));
}

}  // namespace

Asset prepareBricks(gpu::Context& context, const SparseVolume& volume, const vdb::Affine& toWorld,
                    std::shared_ptr<const gpu::Image> pool, const PrepareOptions& options) {
    StepWatch watch(options.check);
    PreparationTimes times;
    const gpu::SpecConstant sparse = gpu::SpecConstant::of(15, true);
    const gpu::Program<shared::SamplePush> sample(context, "sample", spirv::sample_comp, {sparse});
    const gpu::Program<shared::LeafPush> statisticsOf(context, "leaf_statistics_bricks",
                                                      spirv::leaf_statistics_bricks_comp, {sparse});
    const glm::dmat3& voxelToMetres = toWorld.linear;
    gpu::Image bricks = makeBrickIndex(context, volume);
    const DensityImages images{*pool, bricks};
    times.upload = watch.lap();
    const glm::mat3 toMetres = gradientToMetres(voxelToMetres);
    const Blocks blocks = brickBlocks(volume, toMetres, options.check);
    times.majorants = watch.lap();
    std::vector<Sample> samples = sampleGradient(context, sample, images, volume.size, blocks, toMetres, options);
    times.sampling = watch.lap();
    const CoarseDensity coarse = coarseDensity(volume);
    const BlockDensity blockDensity(coarse.values, coarse.size, volume.maximum, coarse.scale);
    KdTree tree = makeTree(samples, volume.size, blockDensity, voxelToMetres, blocks, options);
    times.tree = watch.lap();

    const gpu::Buffer leafBuffer = gpu::filledBuffer(context, "leaves", tree.leaves);
    const auto statistics = leafStatistics(context, statisticsOf, images, volume.size, leafBuffer,
                                           static_cast<std::uint32_t>(tree.leaves.size()));
    std::vector<std::uint32_t> numbers;
    std::vector<Collector> collectors = makeCollectors(tree, statistics, numbers);
    gpu::Image index = indexCollectors(context, volume, tree, numbers);

    times.collectors = watch.lap();

    const double mass = massOf(collectors);
    const MajorantGrid cells = majorantGrid(volume, false, mass);
    const MajorantGrid single = majorantGrid(volume, true, mass);
    const bool local = isLocal(options.majorant, single);
    const MajorantGrid grid = local ? cells : single;
    times.majorants += watch.lap();
    return Asset{volume.size,
                 voxelToMetres,
                 std::abs(glm::determinant(voxelToMetres)),
                 volume.format,
                 std::move(pool),
                 std::move(bricks),
                 std::move(index),
                 grid,
                 majorantImage(context, grid),
                 options.keepBlocks ? cells : MajorantGrid{},
                 cells,
                 local ? std::nullopt : std::optional(majorantImage(context, cells)),
                 std::move(samples),
                 std::move(tree),
                 std::move(collectors),
                 times};
}

}  // namespace lumulus::cloud
