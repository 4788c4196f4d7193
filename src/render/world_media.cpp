#include "render/world_media.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <span>

#include "base/error.h"
#include "gpu/transfer.h"

namespace lumulus {

namespace {

/// The value of a texel in a density format.
float densityOf(vdb::DensityFormat format, const std::byte* texel) {
    if (format == vdb::DensityFormat::r8) return static_cast<float>(*texel) / 255.0F;
    if (format == vdb::DensityFormat::r16f) {
        std::uint16_t half = 0;
        std::memcpy(&half, texel, sizeof(half));
        return glm::unpackHalf1x16(half);
    }
    float value = 0.0F;
    std::memcpy(&value, texel, sizeof(value));
    return value;
}

std::shared_ptr<const query::BrickField> readBack(gpu::Context& context, const cloud::Asset& asset,
                                                  const Check& check) {
    if (asset.isSparse())
        throw InputError("a ground and questions about clouds need their densities as dense volumes",
                         "preparation.storage",
                         "write storage = \"dense\", with a preparation.memory_budget that they fit");
    const auto texels = gpu::download<std::byte>(context, *asset.density);
    const std::size_t bytes = vdb::texelBytes(asset.format);
    vdb::Volume volume;
    volume.size = asset.size;
    volume.maximum = 1.0F;
    volume.density.resize(texels.size() / bytes);
    tbb::parallel_for(std::size_t{0}, volume.density.size(),
                      [&](std::size_t i) { volume.density[i] = densityOf(asset.format, &texels[i * bytes]); });
    return std::make_shared<const query::BrickField>(volume, check);
}

template <class Extinction>
query::Media mediaWith(gpu::Context& context, World& world, const Check& check, const Extinction& extinctionOf) {
    std::vector<query::PlacedField> placed;
    for (const std::size_t i : world.visible()) {
        const cloud::Instance& instance = world.instances[i];
        std::shared_ptr<const query::BrickField>& field = world.fields[instance.asset];
        if (!field) field = readBack(context, *instance.asset, check);
        placed.push_back(
            {field, instance.voxelToMetres, instance.origin + instance.offset, extinctionOf(instance.medium)});
    }
    return {query::Clouds(std::move(placed)), world.fog,
            world.lights.ground ? std::optional(world.lights.ground->height) : std::nullopt};
}

}  // namespace

query::Media mediaOf(gpu::Context& context, World& world, const Check& check) {
    return mediaWith(context, world, check, [](const phase::ScatteringMedium& medium) { return medium.extinction; });
}

query::Media straightMediaOf(gpu::Context& context, World& world, const Check& check) {
    return mediaWith(context, world, check, [](const phase::ScatteringMedium& medium) {
        const double least = std::min(medium.albedo.x, std::min(medium.albedo.y, medium.albedo.z));
        return medium.extinction * (1.0 - static_cast<double>(medium.tables.forwardFraction) * least);
    });
}

}  // namespace lumulus
