#include "gpu/memory.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"

namespace lumulus::gpu {
namespace {

/// The formats that Lumulus uses, with the bytes of a texel.
constexpr std::pair<VkFormat, std::uint64_t> texelSizes[] = {
    {VK_FORMAT_R8_UNORM, 1},   {VK_FORMAT_R16_SFLOAT, 2}, {VK_FORMAT_R16_UINT, 2},
    {VK_FORMAT_R32_SFLOAT, 4}, {VK_FORMAT_R32_UINT, 4},   {VK_FORMAT_R32G32B32A32_SFLOAT, 16},
};

std::uint64_t texelBytes(VkFormat format) {
    for (const auto& [known, bytes] : texelSizes)
        if (known == format) return bytes;
    throw std::logic_error(fmt::format("Lumulus does not use VkFormat {}", static_cast<int>(format)));
}

std::uint64_t texelCount(glm::ivec3 extent, const std::string& name) {
    if (extent.x < 1 || extent.y < 1 || extent.z < 1) throw std::logic_error("image " + name + " has no texels");
    const glm::u64vec3 size(extent);
    return size.x * size.y * size.z;
}

constexpr VkImageSubresourceRange allOfIt{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};

}  // namespace

Buffer::Buffer(Context& context, std::string name, std::uint64_t bytes, Memory where)
    : Resource(std::move(name), bytes == 0 ? 16 : bytes) {
    const std::uint64_t limit = context.limits().maxStorageBufferRange;
    if (bytes_ > limit)
        throw Error(fmt::format("a buffer of {} bytes is above the device's limit of {}", bytes_, limit), name_,
                    "use a smaller cloud, fewer photons or another device");
    const VolkDeviceTable& api = context.api();
    VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    info.size = (bytes_ + 3) / 4 * 4;  // Commands::fill() sets whole words
    info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT |
                 VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                 VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    buffer_ = context.create(api.vkCreateBuffer, api.vkDestroyBuffer, info, VK_OBJECT_TYPE_BUFFER, name_, bytes_);
    VkMemoryRequirements needs{};
    api.vkGetBufferMemoryRequirements(context.handle(), handle(), &needs);
    allocation_ = context.allocator().allocate(name_, needs, where, Tiling::linear);
    check(api.vkBindBufferMemory(context.handle(), handle(), allocation_->memory(), allocation_->offset),
          "vkBindBufferMemory");
    if (where == Memory::host) mapped_ = allocation_->mapped();
}

Buffer::Buffer(Context& context, std::string name, std::uint64_t count, VkFormat texel, Memory where)
    : Buffer(context, std::move(name), std::max<std::uint64_t>(count, 1) * texelBytes(texel), where) {
    const std::uint64_t limit = context.limits().maxTexelBufferElements;
    if (count > limit)
        throw Error(fmt::format("a buffer of {} texels is above the device's limit of {}", count, limit), name_,
                    "use a smaller picture or another device");
    const VkBufferViewCreateInfo info{
        VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO, nullptr, 0, handle(), texel, 0, VK_WHOLE_SIZE};
    texels_ = context.create(context.api().vkCreateBufferView, context.api().vkDestroyBufferView, info,
                             VK_OBJECT_TYPE_BUFFER_VIEW, name_);
}

Image::Image(Context& context, std::string name, glm::ivec2 extent, VkFormat format)
    : Image(context, std::move(name), glm::ivec3(extent, 1), 2, format) {}

Image::Image(Context& context, std::string name, glm::ivec3 extent, VkFormat format)
    : Image(context, std::move(name), extent, 3, format) {}

Image::Image(Context& context, std::string name, glm::ivec3 extent, int dimensions, VkFormat format)
    : Resource(name, texelCount(extent, name) * texelBytes(format)),
      extent_(extent),
      dimensions_(dimensions),
      format_(format) {
    const glm::uvec3 size(extent);
    const VkPhysicalDeviceLimits& limits = context.limits();
    const std::uint32_t side = dimensions == 3 ? limits.maxImageDimension3D : limits.maxImageDimension2D;
    if (size.x > side || size.y > side || size.z > side)
        throw Error(fmt::format("an image of {}x{}x{} texels is above the device's limit of {}x{}x{}", size.x, size.y,
                                size.z, side, side, dimensions == 3 ? side : 1),
                    name_, "use a coarser cloud or another device");
    VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    info.imageType = dimensions == 3 ? VK_IMAGE_TYPE_3D : VK_IMAGE_TYPE_2D;
    info.format = format;
    info.extent = {size.x, size.y, size.z};
    info.mipLevels = info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                 VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    const VolkDeviceTable& api = context.api();
    image_ = context.create(api.vkCreateImage, api.vkDestroyImage, info, VK_OBJECT_TYPE_IMAGE, name_, bytes_);
    VkMemoryRequirements needs{};
    api.vkGetImageMemoryRequirements(context.handle(), handle(), &needs);
    allocation_ = context.allocator().allocate(name_, needs, Memory::device, Tiling::optimal);
    check(api.vkBindImageMemory(context.handle(), handle(), allocation_->memory(), allocation_->offset),
          "vkBindImageMemory");
    const VkImageViewType type = dimensions == 3 ? VK_IMAGE_VIEW_TYPE_3D : VK_IMAGE_VIEW_TYPE_2D;
    const VkImageViewCreateInfo viewInfo{
        VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO, nullptr, 0, handle(), type, format, {}, allOfIt};
    view_ = context.create(api.vkCreateImageView, api.vkDestroyImageView, viewInfo, VK_OBJECT_TYPE_IMAGE_VIEW, name_);
    context.immediately([&](VkCommandBuffer commands) {
        VkImageMemoryBarrier barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
        barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
        barrier.newLayout = VK_IMAGE_LAYOUT_GENERAL;
        barrier.image = handle();
        barrier.subresourceRange = allOfIt;
        constexpr VkPipelineStageFlags all = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
        api.vkCmdPipelineBarrier(commands, all, all, 0, 0, nullptr, 0, nullptr, 1, &barrier);
    });
}

}  // namespace lumulus::gpu
