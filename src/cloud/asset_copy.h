#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cloud/asset.h"

namespace lumulus::cloud {

/// An asset of a dense field on the host, of which another device can have the same.
struct AssetCopy {
    glm::ivec3 size{0};
    glm::dmat3 voxelToMetres{1.0};
    vdb::DensityFormat format = vdb::DensityFormat::r16f;
    std::vector<std::byte> texels;  ///< of the density, as far as they have been read
    MajorantGrid majorants, blocks, cells;
    bool hasCellImage = false;
    std::vector<Sample> samples;
    KdTree tree;
    std::vector<Collector> collectors;
};

/// Bytes that the whole copy of an asset takes on the host.
std::uint64_t copyBytes(const Asset& asset);

/// A copy without texels yet. The asset is of a dense field.
AssetCopy beginCopy(const Asset& asset);

/// Reads slices of the asset's density back, until `bytes` more are there or all. Returns whether it is all.
bool readMore(gpu::Context& context, const Asset& asset, AssetCopy& copy, std::uint64_t bytes);

/// The asset that the whole copy is of, to the bit, on another device; its `times` are 0.
Asset makeAsset(gpu::Context& context, AssetCopy&& copy);

}  // namespace lumulus::cloud
