#include "gpu/memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <glm/gtx/component_wise.hpp>

#include "base/error.h"

namespace lumulus::gpu {
namespace {

std::uint64_t texelBytes(VkFormat format) {
    for (const auto& [known, bytes] : texelSizes)
        if (known == format) return bytes;
    throw std::logic_error(fmt::format("Lumulus does not use VkFormat {}", static_cast<int>(format)));
}

void requirePossible(const Image& image, const VkPhysicalDeviceLimits& limits) {
    const glm::ivec3 extent = image.extent();
    if (extent.x < 1 || extent.y < 1 || extent.z < 1)
        throw std::logic_error("image " + image.name() + " has no texels");
    if (image.levels() < 1 || image.levels() > mipLevels(extent) || (image.isArray() && image.dimensions() == 3))
        throw std::logic_error(fmt::format("image {} of {} dimensions cannot have {} levels of {} layers", image.name(),
                                           image.dimensions(), image.levels(), image.layers()));
    const glm::uvec4 size(image.extent(), image.layers());
    const std::uint32_t flat = limits.maxImageDimension2D;
    const std::uint32_t cube = limits.maxImageDimension3D;
    const glm::uvec4 limit = image.dimensions() == 3 ? glm::uvec4(cube, cube, cube, 1)
                                                     : glm::uvec4(flat, flat, 1, limits.maxImageArrayLayers);
    if (glm::any(glm::greaterThan(size, limit)))
        throw Error(
            fmt::format("an image of {}x{}x{} texels in {} layers is above the device's limit of {}x{}x{} in {}",
                        size.x, size.y, size.z, size.w, limit.x, limit.y, limit.z, limit.w),
            image.name(), "use a coarser cloud or another device");
}

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

int mipLevels(glm::ivec3 extent) {
    return std::bit_width(static_cast<unsigned>(glm::compMax(extent)));
}

glm::ivec3 ImageLevel::extent() const {
    return glm::max(image->extent() >> level, glm::ivec3(1));
}

int ImageLevel::slices() const {
    if (layer) return 1;
    return image->dimensions() == 3 ? extent().z : image->layers();
}

std::uint64_t ImageLevel::bytes() const {
    const glm::u64vec3 size(extent());
    return size.x * size.y * static_cast<std::uint64_t>(slices()) * texelBytes(image->format());
}

Image::Image(Context& context, std::string name, glm::ivec3 extent, int dimensions, VkFormat format, ImageParts parts)
    : Resource(std::move(name), 0), extent_(extent), dimensions_(dimensions), format_(format), parts_(parts) {
    requirePossible(*this, context.limits());
    for (int i = 0; i < levels(); ++i) bytes_ += level(i).bytes();
    const glm::uvec3 size(extent_);
    VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    info.imageType = dimensions_ == 3 ? VK_IMAGE_TYPE_3D : VK_IMAGE_TYPE_2D;
    info.format = format_;
    info.extent = {size.x, size.y, size.z};
    info.mipLevels = static_cast<std::uint32_t>(levels());
    info.arrayLayers = static_cast<std::uint32_t>(layers());
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
    const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, static_cast<std::uint32_t>(levels()), 0,
                                      static_cast<std::uint32_t>(layers())};
    addView(context, all);
    for (std::uint32_t level = 0; level < all.levelCount; ++level)
        addView(context, {VK_IMAGE_ASPECT_COLOR_BIT, level, 1, 0, all.layerCount});
    context.immediately([&](VkCommandBuffer commands) {
        VkImageMemoryBarrier barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
        barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
        barrier.newLayout = VK_IMAGE_LAYOUT_GENERAL;
        barrier.image = handle();
        barrier.subresourceRange = all;
        constexpr VkPipelineStageFlags stages = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
        context.api().vkCmdPipelineBarrier(commands, stages, stages, 0, 0, nullptr, 0, nullptr, 1, &barrier);
    });
}

void Image::addView(Context& context, const VkImageSubresourceRange& range) {
    const VkImageViewType picture = isArray() ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
    const VkImageViewType type = dimensions_ == 3 ? VK_IMAGE_VIEW_TYPE_3D : picture;
    const VkImageViewCreateInfo info{
        VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO, nullptr, 0, handle(), type, format_, {}, range};
    views_.push_back(context.create(context.api().vkCreateImageView, context.api().vkDestroyImageView, info,
                                    VK_OBJECT_TYPE_IMAGE_VIEW, name_));
}

ImageLevel Image::level(int level, std::optional<int> layer) const {
    const int most = dimensions_ == 3 ? extent_.z >> std::clamp(level, 0, 31) : isArray() ? layers() : 0;
    if (level < 0 || level >= levels() || (layer && (*layer < 0 || *layer >= std::max(most, dimensions_ - 2))))
        throw std::logic_error(fmt::format("image {} has {} levels of {} layers: there is no level {}, layer {}", name_,
                                           levels(), layers(), level, layer.value_or(0)));
    return {this, level, layer};
}

}  // namespace lumulus::gpu
