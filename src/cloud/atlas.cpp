#include "cloud/atlas.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/gtx/component_wise.hpp>
#include <numeric>
#include <tuple>
#include <unordered_map>

#include "gpu/groups.h"
#include "gpu/transfer.h"

namespace lumulus::cloud {

namespace {

namespace spirv {
#include "spirv/cloud/copy_index.comp.h"
#include "spirv/cloud/copy_volume.comp.h"
}  // namespace spirv

bool isInteger(VkFormat format) {
    return format == VK_FORMAT_R16_UINT || format == VK_FORMAT_R32_UINT;
}

/// Of each volume, the place in the list where it stands first.
std::vector<std::size_t> firstPlaces(std::span<const gpu::Image* const> volumes) {
    std::unordered_map<const gpu::Image*, std::size_t> known;
    std::vector<std::size_t> first;
    for (std::size_t i = 0; i < volumes.size(); ++i) first.push_back(known.try_emplace(volumes[i], i).first->second);
    return first;
}

/// Packs volumes of these extents into rows, rows into layers, the deepest ones first. Sets where each begins, and
/// returns what they fill together.
glm::ivec3 pack(std::span<const glm::ivec3> extents, std::span<glm::ivec3> origins) {
    std::vector<std::size_t> order(extents.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto key = [&](std::size_t i) { return std::tuple(extents[i].z, extents[i].y, extents[i].x); };
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return key(a) > key(b); });
    double texels = 0.0;
    glm::ivec3 widest(1), filled(1);
    for (const glm::ivec3& extent : extents) {
        texels += static_cast<double>(extent.x) * extent.y * extent.z;
        widest = glm::max(widest, extent);
    }
    const int edge = std::max(glm::compMax(widest), static_cast<int>(std::ceil(std::cbrt(1.2 * texels))));
    glm::ivec3 next(0), used(0);  // where the next one begins; how far row (y) and layer (z) reach
    for (const std::size_t i : order) {
        const glm::ivec3& extent = extents[i];
        if (next.x + extent.x > edge) next = {0, used.y, next.z};
        if (next.y + extent.y > edge) next = {0, 0, used.z};
        if (next.y == 0 && next.x == 0) used.y = 0;
        origins[i] = next;
        used = glm::max(used, next + extent);
        filled = glm::max(filled, next + extent);
        next.x += extent.x;
    }
    return filled;
}

}  // namespace

Atlas::Atlas(gpu::Context& context, const char* name, std::span<const gpu::Image* const> volumes, VkFormat format)
    : program_(context, "copy_volume",
               isInteger(format) ? std::span<const std::uint32_t>(spirv::copy_index_comp)
                                 : std::span<const std::uint32_t>(spirv::copy_volume_comp)) {
    const std::vector<std::size_t> first = firstPlaces(volumes);
    std::vector<std::size_t> distinct;
    for (std::size_t i = 0; i < volumes.size(); ++i)
        if (first[i] == i) distinct.push_back(i);
    std::vector<glm::ivec3> extents, origins(distinct.size());
    for (const std::size_t i : distinct) extents.push_back(volumes[i]->extent() + 1);
    const glm::ivec3 filled = pack(extents, origins);
    for (std::size_t i = 0; i < volumes.size(); ++i) {
        const auto place = std::ranges::lower_bound(distinct, first[i]) - distinct.begin();
        origins_.push_back(origins[static_cast<std::size_t>(place)]);
        extents_.push_back(extents[static_cast<std::size_t>(place)] - 1);
    }
    image_.emplace(context, name, filled, format);
    gpu::clear(context, *image_);
}

bool Atlas::holds(std::span<const gpu::Image* const> volumes) const {
    if (volumes.size() != extents_.size()) return false;
    for (std::size_t i = 0; i < volumes.size(); ++i)
        if (volumes[i]->extent() != extents_[i]) return false;
    return true;
}

void Atlas::record(gpu::Commands& commands, std::span<const gpu::Image* const> volumes) const {
    commands.pass("atlas");
    const std::vector<std::size_t> first = firstPlaces(volumes);
    for (std::size_t i = 0; i < volumes.size(); ++i) {
        if (first[i] != i) continue;
        const glm::ivec3 size = volumes[i]->extent();
        const auto texels = static_cast<std::uint64_t>(size.x) * static_cast<std::uint64_t>(size.y) *
                            static_cast<std::uint64_t>(size.z);
        commands.dispatch(program_, {{"source", *volumes[i], gpu::Sampler::nearest}, {"atlas", *image_}},
                          {size, origins_[i]}, gpu::linearGroups(texels, 64));
        commands.barrier("volume copied");  // all write to one image, and the tracker knows no parts of it
    }
}

}  // namespace lumulus::cloud
