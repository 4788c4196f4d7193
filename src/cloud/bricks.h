#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/interrupt.h"
#include "gpu/memory.h"
#include "vdb/sparse_volume.h"

namespace lumulus::cloud {

/// A pool on the GPU with the texels of all these volumes, which get their places in it, their ranges and majorants.
/// Texels go up region by region. Errors: those of reading leaves, Error where the pool is above the device's limits,
/// what `check` throws.
std::shared_ptr<const gpu::Image> makePool(gpu::Context& context, std::span<vdb::SparseVolume* const> volumes,
                                           const Check& check = stopIfInterrupted);

/// The index of a volume's bricks as shaders read it (lib/bricks.glsl), once its slots have their places.
gpu::Image makeBrickIndex(gpu::Context& context, const vdb::SparseVolume& volume);

/// Texels (two numbers each) of an index image, in rows of 1024.
gpu::Image makeIndexImage(gpu::Context& context, const char* name, std::vector<glm::uvec2> texels);

/// Indices of several volumes in one image.
struct JoinedIndex {
    gpu::Image image;
    std::vector<std::uint32_t> first;  ///< texel of each
};

/// An index that stands in the list twice is copied once.
JoinedIndex joinIndices(gpu::Context& context, std::span<const gpu::Image* const> indices);

}  // namespace lumulus::cloud
