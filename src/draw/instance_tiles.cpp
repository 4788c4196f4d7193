#include "draw/instance_tiles.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "draw/sparse_sampling.h"
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
    std::vector<float> nearest;  ///< distance from the eye at which a ray may meet one [m]
};

Spheres spheresOf(std::span<const cloud::Instance* const> instances, const Camera& camera) {
    Spheres result;
    std::vector<float> nearest;
    for (const cloud::Instance* instance : instances) {
        const glm::dvec3 away = instance->middle() - camera.position;
        const bool parallel = camera.projection == scene::Projection::orthographic;
        const double distance = parallel ? glm::dot(away, camera.axes[2]) : glm::length(away);
        nearest.push_back(static_cast<float>(distance - 0.5 * instance->diagonal() - instance->voxelEdge()));
    }
    result.instances.resize(instances.size());
    std::iota(result.instances.begin(), result.instances.end(), 0U);
    std::ranges::stable_sort(result.instances, {}, [&](std::uint32_t i) { return nearest[i]; });
    for (const std::uint32_t i : result.instances) {
        const double radius = 0.5 * instances[i]->diagonal() + instances[i]->voxelEdge();
        result.spheres.push_back({glm::vec3(instances[i]->middle() - camera.position), static_cast<float>(radius), 0.0F,
                                  static_cast<float>(i)});
        result.nearest.push_back(nearest[i]);
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

std::uint32_t detailOf(int spacing) {
    if (spacing >= widestSpacing) return shared::ANY_DETAIL;
    return spacing > 1 ? shared::DETAIL_OF_SQUARES : shared::DETAIL_OF_PIXELS;
}

/// The finest of the instances of each tile.
std::vector<std::uint32_t> detailOf(const TileLists& tiles, std::span<const Fineness> fineness) {
    std::vector<std::uint32_t> detail;
    for (std::size_t tile = 0; tile + 1 < tiles.offsets.size(); ++tile) {
        std::uint32_t finest = shared::ANY_DETAIL, rays = 1;
        for (std::uint32_t entry = tiles.offsets[tile]; entry < tiles.offsets[tile + 1]; ++entry) {
            const Fineness& one = fineness[tiles.lists[entry]];
            finest = std::max(finest, detailOf(one.spacing));
            rays = std::max(rays, static_cast<std::uint32_t>(one.rays));
        }
        detail.push_back(finest | rays << shared::DETAIL_RAYS_SHIFT);
    }
    return detail;
}

double pixelShareOf(const TileLists& tiles, std::span<const std::uint32_t> detail) {
    std::size_t shown = 0, drawn = 0;
    for (std::size_t tile = 0; tile < detail.size(); ++tile) {
        if (tiles.offsets[tile] == tiles.offsets[tile + 1]) continue;
        ++shown;
        if ((detail[tile] & 3U) == shared::DETAIL_OF_PIXELS) ++drawn;
    }
    return shown == 0 ? 0.0 : static_cast<double>(drawn) / static_cast<double>(shown);
}

}  // namespace

InstanceTiles::InstanceTiles(gpu::Context& context, const TileLists& tiles, std::span<const glm::uvec2> lists,
                             std::span<const glm::vec4> places, std::span<const std::uint32_t> detail)
    : across_(tiles.across),
      offsets_(gpu::filledBuffer(context, "tile offsets", tiles.offsets)),
      lists_(texelBuffer(context, "tile lists", lists, VK_FORMAT_R32G32_UINT)),
      places_(texelBuffer(context, "instance places", places, VK_FORMAT_R32G32B32A32_SFLOAT)),
      detail_(gpu::filledBuffer(context, "tile detail", std::vector(detail.begin(), detail.end()))) {}

InstanceTiles::InstanceTiles(gpu::Context& context)
    : InstanceTiles(context, TileLists{0, 0, {0, 0}, {}}, std::span<const glm::uvec2>{}, std::span<const glm::vec4>{},
                    std::vector{1U << shared::DETAIL_RAYS_SHIFT}) {}

InstanceTiles::InstanceTiles(gpu::Context& context, std::span<const cloud::Instance* const> instances,
                             std::span<const Fineness> fineness, const Camera& camera)
    : InstanceTiles([&] {
          const Spheres spheres = spheresOf(instances, camera);
          TileLists tiles = makeTileLists(camera, spheres.spheres);
          std::vector<glm::uvec2> lists;
          for (std::uint32_t& entry : tiles.lists) {
              const float nearest = spheres.nearest[entry];
              entry = spheres.instances[entry];
              lists.emplace_back(entry, std::bit_cast<std::uint32_t>(nearest));
          }
          const std::vector<std::uint32_t> detail = detailOf(tiles, fineness);
          InstanceTiles made(context, tiles, lists, placeTexels(instances, camera), detail);
          made.pixelShare_ = pixelShareOf(tiles, detail);
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
