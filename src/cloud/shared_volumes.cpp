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

SharedVolumes::SharedVolumes(gpu::Context& context, std::span<const Instance* const> instances) {
    std::vector<const gpu::Image*> densities, majorants, bricks, collectors;
    for (const Instance* instance : instances) {
        densities.push_back(instance->asset->density.get());
        majorants.push_back(&instance->asset->marchedCells());
        bricks.push_back(&instance->asset->brickIndex());
        collectors.push_back(&instance->asset->collectorIndex);
    }
    majorants_.emplace(context, "majorant atlas", majorants, VK_FORMAT_R32_SFLOAT);
    if (instances.front()->asset->isSparse()) {
        pool_ = instances.front()->asset->density;
        bricks_ = joinIndices(context, bricks);
        nodes_ = joinIndices(context, collectors);
    } else {
        densities_.emplace(context, "density atlas", densities, formatOfAll(densities, VK_FORMAT_R32_SFLOAT));
        collectors_.emplace(context, "collector atlas", collectors, formatOfAll(collectors, VK_FORMAT_R32_UINT));
    }
    gpu::Commands commands(context);
    commands.begin();
    majorants_->record(commands, majorants);
    if (densities_) densities_->record(commands, densities);
    if (collectors_) collectors_->record(commands, collectors);
    commands.submit();
    commands.wait();
}

glm::vec3 SharedVolumes::place(std::size_t instance) const {
    if (sparse())
        return {static_cast<float>(bricks_->first[instance]), static_cast<float>(nodes_->first[instance]), 0.0F};
    return glm::vec3(densities_->origin(instance));
}

}  // namespace lumulus::cloud
