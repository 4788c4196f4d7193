#include "cloud/shared_volumes.h"

#include <algorithm>

namespace lumulus::cloud {

namespace {

/// A format that holds all of them without loss.
VkFormat formatOfAll(std::span<const gpu::Image* const> images, VkFormat widest) {
    const VkFormat first = images.front()->format();
    return std::ranges::all_of(images, [&](const gpu::Image* image) { return image->format() == first; }) ? first
                                                                                                          : widest;
}

}  // namespace

SharedVolumes makeSharedVolumes(gpu::Context& context, std::span<const Instance* const> instances) {
    std::vector<const gpu::Image*> densities, majorants, collectors;
    for (const Instance* instance : instances) {
        densities.push_back(&instance->asset->density);
        majorants.push_back(&instance->asset->marchedCells());
        collectors.push_back(&instance->asset->collectorIndex);
    }
    SharedVolumes volumes{Atlas(context, "density atlas", densities, formatOfAll(densities, VK_FORMAT_R32_SFLOAT)),
                          Atlas(context, "majorant atlas", majorants, VK_FORMAT_R32_SFLOAT),
                          Atlas(context, "collector atlas", collectors, formatOfAll(collectors, VK_FORMAT_R32_UINT))};
    gpu::Commands commands(context);
    commands.begin();
    volumes.densities.record(commands, densities);
    volumes.majorants.record(commands, majorants);
    volumes.collectors.record(commands, collectors);
    commands.submit();
    commands.wait();
    return volumes;
}

}  // namespace lumulus::cloud
