#include "cloud/atlas.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "gpu/groups.h"
#include "gpu/transfer.h"

namespace lumulus::cloud {

namespace {

namespace spirv {
#include "spirv/cloud/copy_volume.comp.h"
}  // namespace spirv

std::size_t firstOf(std::span<const gpu::Image* const> volumes, std::size_t i) {
    return static_cast<std::size_t>(std::ranges::find(volumes, volumes[i]) - volumes.begin());
}

}  // namespace

Atlas::Atlas(gpu::Context& context, const char* name, std::span<const gpu::Image* const> volumes, VkFormat format)
    : program_(context, "copy_volume", spirv::copy_volume_comp) {
    int slots = 0;
    for (std::size_t i = 0; i < volumes.size(); ++i) {
        slot_ = glm::max(slot_, volumes[i]->extent() + 1);
        slots += firstOf(volumes, i) == i ? 1 : 0;
    }
    const int across = static_cast<int>(std::ceil(std::cbrt(slots) - 1e-9));
    const int deep = (slots + across * across - 1) / (across * across);
    const int high = std::min(across, (slots + across - 1) / across);
    int next = 0;
    for (std::size_t i = 0; i < volumes.size(); ++i) {
        if (firstOf(volumes, i) != i) {
            origins_.push_back(origins_[firstOf(volumes, i)]);
            continue;
        }
        origins_.push_back(slot_ * glm::ivec3(next % across, next / across % across, next / (across * across)));
        ++next;
    }
    image_.emplace(context, name, slot_ * glm::ivec3(std::min(across, slots), high, deep), format);
    gpu::upload(context, *image_, std::vector<std::byte>(image_->bytes()));
}

bool Atlas::holds(std::span<const gpu::Image* const> volumes) const {
    return volumes.size() == origins_.size() && std::ranges::all_of(volumes, [&](const gpu::Image* volume) {
               return glm::all(glm::lessThan(volume->extent(), slot_));
           });
}

void Atlas::record(gpu::Commands& commands, std::span<const gpu::Image* const> volumes) const {
    commands.pass("atlas");
    for (std::size_t i = 0; i < volumes.size(); ++i) {
        if (firstOf(volumes, i) != i) continue;
        const glm::ivec3 size = volumes[i]->extent();
        const auto texels = static_cast<std::uint64_t>(size.x) * static_cast<std::uint64_t>(size.y) *
                            static_cast<std::uint64_t>(size.z);
        commands.dispatch(program_, {{"source", *volumes[i], gpu::Sampler::nearest}, {"atlas", *image_}},
                          {size, origins_[i]}, gpu::linearGroups(texels, 64));
        commands.barrier("volume copied");
    }
}

}  // namespace lumulus::cloud
