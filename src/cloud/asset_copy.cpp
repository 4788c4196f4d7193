#include "cloud/asset_copy.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "cloud/prepare_parts.h"
#include "cloud/prepare_programs.h"
#include "gpu/transfer.h"
#include "shared/photon.h"

namespace lumulus::cloud {

namespace {

template <class Value>
std::uint64_t bytesOf(const std::vector<Value>& values) {
    return values.size() * sizeof(Value);
}

/// The collector of each leaf, as makeCollectors() has given it.
std::vector<std::uint32_t> numbersOf(const KdTree& tree, const std::vector<Collector>& collectors) {
    std::vector<std::uint32_t> numbers(tree.leaves.size(), shared::NO_COLLECTOR);
    std::uint32_t next = 0;
    for (std::size_t leaf = 0; leaf < tree.leaves.size() && next < collectors.size(); ++leaf) {
        const shared::LeafBox& box = collectors[next].box;
        if (tree.leaves[leaf].lower == box.lower && tree.leaves[leaf].upper == box.upper) numbers[leaf] = next++;
    }
    return numbers;
}

}  // namespace

std::uint64_t copyBytes(const Asset& asset) {
    return asset.density->bytes() + bytesOf(asset.majorants.maxima) + bytesOf(asset.blocks.maxima) +
           bytesOf(asset.cells.maxima) + bytesOf(asset.samples) + bytesOf(asset.tree.nodes) +
           bytesOf(asset.tree.leaves) + bytesOf(asset.collectors);
}

AssetCopy beginCopy(const Asset& asset) {
    AssetCopy copy;
    copy.size = asset.size;
    copy.voxelToMetres = asset.voxelToMetres;
    copy.format = asset.format;
    copy.texels.reserve(asset.density->bytes());
    copy.majorants = asset.majorants;
    copy.blocks = asset.blocks;
    copy.cells = asset.cells;
    copy.hasCellImage = asset.cellImage.has_value();
    copy.samples = asset.samples;
    copy.tree = asset.tree;
    copy.collectors = asset.collectors;
    return copy;
}

bool readMore(gpu::Context& context, const Asset& asset, AssetCopy& copy, std::uint64_t bytes) {
    const gpu::Image& density = *asset.density;
    const std::uint64_t slice = density.level(0, 0).bytes();
    const std::uint64_t wanted = std::min(density.bytes(), copy.texels.size() + std::max(bytes, slice));
    while (copy.texels.size() < wanted) {
        const std::uint64_t read = copy.texels.size();
        const bool whole = read == 0 && density.bytes() <= wanted;  // at once
        copy.texels.resize(whole ? density.bytes() : read + slice);
        const auto place = whole ? density.level(0) : density.level(0, static_cast<int>(read / slice));
        gpu::transfer(context, place, std::as_writable_bytes(std::span(copy.texels).subspan(read)));
    }
    return copy.texels.size() == density.bytes();
}

Asset makeAsset(gpu::Context& context, AssetCopy&& copy) {
    auto density = std::make_shared<gpu::Image>(context, "density", copy.size, formatOf(copy.format));
    gpu::upload(context, *density, copy.texels);
    const gpu::Buffer leafBuffer = gpu::filledBuffer(context, "leaves", copy.tree.leaves);
    gpu::Image index = indexCollectors(context, leafIndexProgram(context), copy.size, leafBuffer,
                                       numbersOf(copy.tree, copy.collectors), copy.collectors.size());
    gpu::Image majorants = majorantImage(context, copy.majorants);
    std::optional<gpu::Image> cellImage;
    if (copy.hasCellImage) cellImage = majorantImage(context, copy.cells);
    return Asset{copy.size,
                 copy.voxelToMetres,
                 std::abs(glm::determinant(copy.voxelToMetres)),
                 copy.format,
                 std::move(density),
                 std::nullopt,
                 std::move(index),
                 std::move(copy.majorants),
                 std::move(majorants),
                 std::move(copy.blocks),
                 std::move(copy.cells),
                 std::move(cellImage),
                 std::move(copy.samples),
                 std::move(copy.tree),
                 std::move(copy.collectors),
                 {}};
}

}  // namespace lumulus::cloud
