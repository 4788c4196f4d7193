#include "gpu/memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "base/error.h"
#include "gpu/transfer.h"

namespace lumulus::gpu {
namespace {

/// The first memory type that fits, with as many of the wanted properties as one has, best wish first.
std::uint32_t findMemoryType(VkPhysicalDevice device, std::uint32_t allowed, Memory where) {
    constexpr VkMemoryPropertyFlags host = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    const VkMemoryPropertyFlags hostWishes[] = {host | VK_MEMORY_PROPERTY_HOST_CACHED_BIT, host};
    const VkMemoryPropertyFlags deviceWishes[] = {VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0};
    VkPhysicalDeviceMemoryProperties memory{};
    vkGetPhysicalDeviceMemoryProperties(device, &memory);
    for (const VkMemoryPropertyFlags wish : where == Memory::host ? hostWishes : deviceWishes)
        for (std::uint32_t i = 0; i < memory.memoryTypeCount; ++i)
            if ((allowed & (1U << i)) != 0 && (memory.memoryTypes[i].propertyFlags & wish) == wish) return i;
    throw std::logic_error("Vulkan promises a memory type for every buffer and image");
}

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

void requireSize(bool fits, const Resource& resource, std::uint64_t given) {
    if (fits) return;
    throw std::logic_error(fmt::format("{} has {} bytes, the transfer {}", resource.name(), resource.bytes(), given));
}

std::uint64_t sliceBytes(const Image& image) {
    return image.bytes() / static_cast<std::uint64_t>(image.extent().z);
}

std::uint64_t pieceBytes(const Image& image) {
    return std::max<std::uint64_t>(1, stagingBytes / sliceBytes(image)) * sliceBytes(image);
}

VkBufferImageCopy slices(const Image& image, std::uint64_t offset, std::uint64_t bytes) {
    const glm::uvec3 extent(image.extent());
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageOffset.z = static_cast<std::int32_t>(offset / sliceBytes(image));
    region.imageExtent = {extent.x, extent.y, static_cast<std::uint32_t>(bytes / sliceBytes(image))};
    return region;
}

/// `copy` records the copy of so many bytes at an offset, from the staging buffer (const bytes) or to it.
template <class Byte, class Copy>
void copyPieces(Context& context, std::span<Byte> bytes, std::uint64_t most, const Copy& copy) {
    const Buffer staging(context, "staging", std::min<std::uint64_t>(bytes.size(), most), Memory::host);
    std::byte* mapped = staging.mapped<std::byte>().data();
    for (std::uint64_t offset = 0; offset < bytes.size(); offset += most) {
        const auto piece = bytes.subspan(offset, std::min<std::uint64_t>(most, bytes.size() - offset));
        if constexpr (std::is_const_v<Byte>) std::memcpy(mapped, piece.data(), piece.size());
        context.immediately([&](VkCommandBuffer commands) { copy(commands, staging.handle(), offset, piece.size()); });
        if constexpr (!std::is_const_v<Byte>) std::memcpy(piece.data(), mapped, piece.size());
    }
    if constexpr (std::is_const_v<Byte>)
        context.addUploaded(bytes.size());
    else
        context.addDownloaded(bytes.size());
}

}  // namespace

Allocation allocate(Context& context, const std::string& resource, const VkMemoryRequirements& needs, Memory where) {
    const std::uint32_t type = findMemoryType(context.physicalDevice(), needs.memoryTypeBits, where);
    const VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, needs.size, type};
    const bool fits = needs.size <= context.maxAllocationBytes();  // some drivers take more, and fail when it is used
    checkMemory(fits ? VK_SUCCESS : VK_ERROR_OUT_OF_DEVICE_MEMORY, "vkAllocateMemory", resource, needs.size);
    Owned<VkDeviceMemory> memory = context.create(context.api().vkAllocateMemory, context.api().vkFreeMemory, info,
                                                  VK_OBJECT_TYPE_DEVICE_MEMORY, resource, needs.size);
    context.addAllocated(needs.size);
    return {memory.release(), {&context, needs.size}};
}

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
    allocation_ = allocate(context, name_, needs, where);
    check(api.vkBindBufferMemory(context.handle(), handle(), allocation_.get(), 0), "vkBindBufferMemory");
    if (where == Memory::host)
        checkMemory(api.vkMapMemory(context.handle(), allocation_.get(), 0, VK_WHOLE_SIZE, 0, &mapped_), "vkMapMemory",
                    name_, bytes_);
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
    allocation_ = allocate(context, name_, needs, Memory::device);
    check(api.vkBindImageMemory(context.handle(), handle(), allocation_.get(), 0), "vkBindImageMemory");
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

void uploadBytes(Context& context, Buffer& to, std::span<const std::byte> bytes) {
    requireSize(bytes.size() <= to.bytes(), to, bytes.size());
    copyPieces(context, bytes, stagingBytes, [&](auto commands, auto staging, auto offset, auto count) {
        const VkBufferCopy region{0, offset, count};
        context.api().vkCmdCopyBuffer(commands, staging, to.handle(), 1, &region);
    });
}

void downloadBytes(Context& context, const Buffer& from, std::span<std::byte> bytes) {
    requireSize(bytes.size() <= from.bytes(), from, bytes.size());
    copyPieces(context, bytes, stagingBytes, [&](auto commands, auto staging, auto offset, auto count) {
        const VkBufferCopy region{offset, 0, count};
        context.api().vkCmdCopyBuffer(commands, from.handle(), staging, 1, &region);
    });
}

void uploadBytes(Context& context, Image& to, std::span<const std::byte> bytes) {
    requireSize(bytes.size() == to.bytes(), to, bytes.size());
    copyPieces(context, bytes, pieceBytes(to), [&](auto commands, auto staging, auto offset, auto count) {
        const VkBufferImageCopy region = slices(to, offset, count);
        context.api().vkCmdCopyBufferToImage(commands, staging, to.handle(), VK_IMAGE_LAYOUT_GENERAL, 1, &region);
    });
}

void downloadBytes(Context& context, const Image& from, std::span<std::byte> bytes) {
    requireSize(bytes.size() == from.bytes(), from, bytes.size());
    copyPieces(context, bytes, pieceBytes(from), [&](auto commands, auto staging, auto offset, auto count) {
        const VkBufferImageCopy region = slices(from, offset, count);
        context.api().vkCmdCopyImageToBuffer(commands, from.handle(), VK_IMAGE_LAYOUT_GENERAL, staging, 1, &region);
    });
}

}  // namespace lumulus::gpu
