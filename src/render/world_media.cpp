#include "render/world_media.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <map>
#include <span>

#include "gpu/transfer.h"

namespace lumulus {

namespace {

/// Pools that have been read back: assets share them.
using Pools = std::map<const gpu::Image*, std::vector<std::byte>>;

query::BrickField readBricks(gpu::Context& context, const cloud::Asset& asset, Pools& pools, const Check& check) {
    std::vector<std::byte>& pool = pools[asset.density.get()];
    if (pool.empty()) pool = gpu::download<std::byte>(context, *asset.density);
    const auto texels = gpu::download<glm::uvec2>(context, *asset.bricks);
    constexpr int edge = vdb::SparseVolume::brickEdge * vdb::SparseVolume::nodeEdge;
    const glm::ivec3 roots = (asset.size + edge - 1) / edge;
    const auto first = static_cast<std::uint32_t>(roots.x * roots.y * roots.z);
    std::vector<std::uint32_t> nodes;
    std::uint32_t last = 0;
    for (std::uint32_t i = 0; i < first; ++i) {
        nodes.push_back((texels[i].x - first) / vdb::SparseVolume::nodeEntries);
        last = std::max(last, nodes.back());
    }
    std::vector<vdb::BrickEntry> entries;
    for (std::size_t i = 0; i < std::size_t{vdb::SparseVolume::nodeEntries} * (last + 1); ++i)
        entries.push_back({texels[first + i].x, texels[first + i].y});
    const auto read = [&](std::uint32_t place, std::span<float, vdb::SparseVolume::slotTexels> to) {
        constexpr int slot = vdb::SparseVolume::slotEdge;
        const glm::ivec3 size = asset.density->extent();
        const glm::ivec3 corner = slot * glm::ivec3(vdb::slotOf(place));
        std::size_t texel = 0;
        for (int z = 0; z < slot; ++z)
            for (int y = 0; y < slot; ++y) {
                const std::size_t row = static_cast<std::size_t>(corner.x) +
                                        static_cast<std::size_t>(size.x) *
                                            (static_cast<std::size_t>(corner.y + y) +
                                             static_cast<std::size_t>(size.y) * static_cast<std::size_t>(corner.z + z));
                for (std::size_t x = 0; x < slot; ++x) to[texel++] = vdb::texelValue(pool, row + x, asset.format);
            }
    };
    return {{asset.size, nodes, entries}, read, check};
}

query::BrickField readBack(gpu::Context& context, const cloud::Asset& asset, Pools& pools, const Check& check) {
    if (asset.isSparse()) return readBricks(context, asset, pools, check);
    const auto texels = gpu::download<std::byte>(context, *asset.density);
    vdb::Volume volume;
    volume.size = asset.size;
    volume.maximum = 1.0F;
    volume.density.resize(texels.size() / vdb::texelBytes(asset.format));
    tbb::parallel_for(std::size_t{0}, volume.density.size(),
                      [&](std::size_t i) { volume.density[i] = vdb::texelValue(texels, i, asset.format); });
    return query::BrickField(volume, check);
}

/// One for each visible instance.
template <class Extinction>
std::vector<query::PlacedField> placedFields(gpu::Context& context, World& world, const Check& check,
                                             const Extinction& extinctionOf) {
    std::vector<query::PlacedField> placed;
    Pools pools;
    for (const std::size_t i : world.visible()) {
        const cloud::Instance& instance = world.instances[i];
        std::shared_ptr<const query::BrickField>& field = (*world.fields)[instance.asset];
        if (!field) field = std::make_shared<const query::BrickField>(readBack(context, *instance.asset, pools, check));
        placed.push_back(
            {field, instance.voxelToMetres, instance.origin + instance.offset, extinctionOf(instance.medium)});
    }
    return placed;
}

double wholeExtinction(const phase::ScatteringMedium& medium) {
    return medium.extinction;
}

template <class Extinction>
query::Media mediaWith(gpu::Context& context, World& world, const Check& check, const Extinction& extinctionOf) {
    return {query::Clouds(placedFields(context, world, check, extinctionOf)), world.fog,
            world.lights.ground ? std::optional(world.lights.ground->height) : std::nullopt};
}

}  // namespace

query::Media mediaOf(gpu::Context& context, World& world, const Check& check) {
    return mediaWith(context, world, check, wholeExtinction);
}

query::Media straightMediaOf(gpu::Context& context, World& world, const Check& check) {
    return mediaWith(context, world, check, [](const phase::ScatteringMedium& medium) {
        const double least = std::min(medium.albedo.x, std::min(medium.albedo.y, medium.albedo.z));
        return medium.extinction * (1.0 - static_cast<double>(medium.tables.forwardFraction) * least);
    });
}

std::vector<query::CloudField> fieldsOf(gpu::Context& context, World& world, const Check& check) {
    std::vector<query::PlacedField> placed = placedFields(context, world, check, wholeExtinction);
    std::vector<query::CloudField> fields;
    for (const std::size_t i : world.visible()) fields.push_back({i, std::move(placed[fields.size()])});
    return fields;
}

std::vector<lamp::Cloud> cloudsForLamps(gpu::Context& context, World& world, const Check& check) {
    std::vector<query::PlacedField> placed = placedFields(context, world, check, wholeExtinction);
    std::vector<lamp::Cloud> clouds;
    for (const std::size_t i : world.visible()) {
        const phase::ScatteringMedium& medium = world.instances[i].medium;
        clouds.push_back({std::move(placed[clouds.size()]), medium.albedo, lamp::CloudPhase(medium.tables)});
    }
    return clouds;
}

}  // namespace lumulus
