#include "draw/instance_tiles.h"

#include <algorithm>
#include <numeric>

#include "gpu/transfer.h"

namespace lumulus::draw {

namespace {

template <class Texel>
gpu::Buffer texelBuffer(gpu::Context& context, const char* name, std::span<const Texel> texels, VkFormat format) {
    gpu::Buffer buffer(context, name, std::max<std::uint64_t>(1, texels.size()), format, gpu::Memory::device);
    if (!texels.empty()) gpu::upload(context, buffer, texels);
    return buffer;
}

/// Spheres round the instances, nearest first, and whose each is.
struct Spheres {
    std::vector<shared::Billboard> spheres;
    std::vector<std::uint32_t> instances;
};

Spheres spheresOf(std::span<const cloud::Instance* const> instances, const Camera& camera) {
    Spheres result;
    std::vector<double> nearest;
    for (const cloud::Instance* instance : instances)
        nearest.push_back(glm::length(instance->middle() - camera.position) - 0.5 * instance->diagonal());
    result.instances.resize(instances.size());
    std::iota(result.instances.begin(), result.instances.end(), 0U);
    std::ranges::stable_sort(result.instances, {}, [&](std::uint32_t i) { return nearest[i]; });
    for (const std::uint32_t i : result.instances) {
        const double radius = 0.5 * instances[i]->diagonal() + instances[i]->voxelEdge();
        result.spheres.push_back({glm::vec3(instances[i]->middle() - camera.position), static_cast<float>(radius), 0.0F,
                                  static_cast<float>(i)});
    }
    return result;
}

/// Rows of the way from metres beyond the eye to voxels; size and length of a voxel.
std::vector<glm::vec4> placeTexels(std::span<const cloud::Instance* const> instances, const Camera& camera) {
    std::vector<glm::vec4> texels;
    for (const cloud::Instance* instance : instances) {
        const glm::dmat3 toVoxel = glm::inverse(instance->voxelToMetres);
        const glm::dvec3 eye = instance->toVoxel(camera.position);
        for (int row = 0; row < 3; ++row)
            texels.emplace_back(glm::dvec4(toVoxel[0][row], toVoxel[1][row], toVoxel[2][row], eye[row]));
        texels.emplace_back(glm::vec3(instance->asset->size), static_cast<float>(instance->voxelEdge()));
    }
    return texels;
}

}  // namespace

InstanceTiles::InstanceTiles(gpu::Context& context, const TileLists& tiles, std::span<const std::uint32_t> lists,
                             std::span<const glm::vec4> places)
    : across_(tiles.across),
      offsets_(gpu::filledBuffer(context, "tile offsets", tiles.offsets)),
      lists_(texelBuffer(context, "tile lists", lists, VK_FORMAT_R32_UINT)),
      places_(texelBuffer(context, "instance places", places, VK_FORMAT_R32G32B32A32_SFLOAT)) {}

InstanceTiles::InstanceTiles(gpu::Context& context)
    : InstanceTiles(context, TileLists{0, 0, {0, 0}, {}}, std::span<const std::uint32_t>{},
                    std::span<const glm::vec4>{}) {}

InstanceTiles::InstanceTiles(gpu::Context& context, std::span<const cloud::Instance* const> instances,
                             const Camera& camera)
    : InstanceTiles([&] {
          const Spheres spheres = spheresOf(instances, camera);
          TileLists tiles = makeTileLists(camera, spheres.spheres);
          for (std::uint32_t& entry : tiles.lists) entry = spheres.instances[entry];
          InstanceTiles made(context, tiles, tiles.lists, placeTexels(instances, camera));
          made.listed_.assign(instances.size(), false);
          for (const std::uint32_t instance : tiles.lists) made.listed_[instance] = true;
          return made;
      }()) {}

void InstanceTiles::addBindings(std::vector<gpu::Binding>& bindings) const {
    bindings.emplace_back("TileOffsets", offsets_);
    bindings.emplace_back("tileLists", lists_);
    bindings.emplace_back("instancePlaces", places_);
}

}  // namespace lumulus::draw
