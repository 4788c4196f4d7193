#include "gpu/memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "gpu/result.h"

namespace lumulus::gpu {
namespace {

/// The first memory type that fits, with as many of the wanted properties as one has, best wish first.
std::uint32_t findMemoryType(VkPhysicalDevice device, std::uint32_t allowed, Memory where) {
    constexpr VkMemoryPropertyFlags host = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    const VkMemoryPropertyFlags hostWishes[] = {host | VK_MEMORY_PROPERTY_HOST_CACHED_BIT, host};
    const VkMemoryPropertyFlags deviceWishes[] = {VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0};
    VkPhysicalDeviceMemoryProperties memory{};
    vkGetPhysicalDeviceMemoryProperties(device, &memory);
    for (const VkMemoryPropertyFlags wish : where == Memory::host ? hostWishes : deviceWishes) {
        for (std::uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
            if ((allowed & (1U << i)) != 0 && (memory.memoryTypes[i].propertyFlags & wish) == wish) {
                return i;
            }
        }
    }
    throw std::logic_error("Vulkan promises a memory type for every buffer and image");
}

struct TexelFormat {
    VkFormat format;
    std::uint64_t bytes;
    bool integer;
};

const TexelFormat& texelFormat(VkFormat format) {
    static constexpr TexelFormat formats[] = {
        {VK_FORMAT_R8_UNORM, 1, false},
        {VK_FORMAT_R8_UINT, 1, true},
        {VK_FORMAT_R16_SFLOAT, 2, false},
        {VK_FORMAT_R16_UINT, 2, true},
        {VK_FORMAT_R32_SFLOAT, 4, false},
        {VK_FORMAT_R32_UINT, 4, true},
        {VK_FORMAT_R8G8B8A8_UNORM, 4, false},
        {VK_FORMAT_R16G16_SFLOAT, 4, false},
        {VK_FORMAT_R32G32_SFLOAT, 8, false},
        {VK_FORMAT_R16G16B16A16_SFLOAT, 8, false},
        {VK_FORMAT_R32G32B32A32_SFLOAT, 16, false},
    };
    const auto* found =
        std::find_if(std::begin(formats), std::end(formats), [&](const TexelFormat& f) { return f.format == format; });
    if (found == std::end(formats)) {
        throw std::logic_error(fmt::format("no texel size is known for VkFormat {}", static_cast<int>(format)));
    }
    return *found;
}

std::string sizeText(VkExtent3D extent) {
    return fmt::format("{}x{}x{}", extent.width, extent.height, extent.depth);
}

}  // namespace

std::uint64_t texelBytes(VkFormat format) {
    return texelFormat(format).bytes;
}

Allocation::Allocation(Context& context, const std::string& resource, const VkMemoryRequirements& needs, Memory where)
    : context_(&context) {
    if (needs.size > context.maxAllocationBytes()) {
        checkMemory(VK_ERROR_OUT_OF_DEVICE_MEMORY, "vkAllocateMemory", resource, needs.size);
    }
    VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    info.allocationSize = needs.size;
    info.memoryTypeIndex = findMemoryType(context.physicalDevice(), needs.memoryTypeBits, where);
    VkDeviceMemory memory = VK_NULL_HANDLE;
    checkMemory(context.api().vkAllocateMemory(context.handle(), &info, nullptr, &memory), "vkAllocateMemory", resource,
                needs.size);
    memory_ = {context.handle(), memory, context.api().vkFreeMemory};
    bytes_ = needs.size;
    context.addAllocated(bytes_);
    context.setName(VK_OBJECT_TYPE_DEVICE_MEMORY, reinterpret_cast<std::uint64_t>(memory), resource);
}

Allocation::Allocation(Allocation&& other) noexcept
    : context_(other.context_), bytes_(std::exchange(other.bytes_, 0)), memory_(std::move(other.memory_)) {}

Allocation& Allocation::operator=(Allocation&& other) noexcept {
    Allocation old(std::move(other));
    std::swap(context_, old.context_);
    std::swap(bytes_, old.bytes_);
    std::swap(memory_, old.memory_);
    return *this;
}

Allocation::~Allocation() {
    if (bytes_ > 0) {
        context_->subtractAllocated(bytes_);
    }
}

Buffer::Buffer(Context& context, std::string name, std::uint64_t bytes, Memory where)
    : name_(std::move(name)), bytes_(bytes == 0 ? 16 : bytes), id_(context.nextResourceId()) {
    const std::uint64_t limit = context.limits().maxStorageBufferRange;
    if (bytes_ > limit) {
        throw Error(fmt::format("a buffer of {} bytes is above the device's limit of {}", bytes_, limit), name_,
                    "use a smaller cloud, fewer photons or another device");
    }
    const VolkDeviceTable& api = context.api();
    VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    info.size = (bytes_ + 3) / 4 * 4;  // fill() sets whole words
    info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT |
                 VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    buffer_ = context.create(api.vkCreateBuffer, api.vkDestroyBuffer, info, VK_OBJECT_TYPE_BUFFER, name_, bytes_);
    VkBuffer buffer = buffer_.get();
    VkMemoryRequirements needs{};
    api.vkGetBufferMemoryRequirements(context.handle(), buffer, &needs);
    allocation_ = Allocation(context, name_, needs, where);
    checkMemory(api.vkBindBufferMemory(context.handle(), buffer, allocation_.handle(), 0), "vkBindBufferMemory", name_,
                needs.size);
    if (where == Memory::host) {
        checkMemory(api.vkMapMemory(context.handle(), allocation_.handle(), 0, VK_WHOLE_SIZE, 0, &mapped_),
                    "vkMapMemory", name_, bytes_);
    }
}

Image::Image(Context& context, std::string name, glm::ivec2 extent, VkFormat format)
    : Image(context, std::move(name), glm::ivec3(extent, 1), 2, format) {}

Image::Image(Context& context, std::string name, glm::ivec3 extent, VkFormat format)
    : Image(context, std::move(name), extent, 3, format) {}

Image::Image(Context& context, std::string name, glm::ivec3 extent, int dimensions, VkFormat format)
    : name_(std::move(name)),
      extent_(extent),
      dimensions_(dimensions),
      format_(format),
      bytes_(texelBytes(format)),
      id_(context.nextResourceId()) {
    const VkImageCreateInfo info = describe(context);
    bytes_ *= static_cast<std::uint64_t>(extent.x) * static_cast<std::uint64_t>(extent.y) *
              static_cast<std::uint64_t>(extent.z);
    const VolkDeviceTable& api = context.api();
    image_ = context.create(api.vkCreateImage, api.vkDestroyImage, info, VK_OBJECT_TYPE_IMAGE, name_, bytes_);
    VkImage image = image_.get();
    VkMemoryRequirements needs{};
    api.vkGetImageMemoryRequirements(context.handle(), image, &needs);
    allocation_ = Allocation(context, name_, needs, Memory::device);
    checkMemory(api.vkBindImageMemory(context.handle(), image, allocation_.handle(), 0), "vkBindImageMemory", name_,
                needs.size);

    VkImageViewCreateInfo viewInfo{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    viewInfo.image = image;
    viewInfo.viewType = dimensions == 3 ? VK_IMAGE_VIEW_TYPE_3D : VK_IMAGE_VIEW_TYPE_2D;
    viewInfo.format = format;
    viewInfo.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    view_ = context.create(api.vkCreateImageView, api.vkDestroyImageView, viewInfo, VK_OBJECT_TYPE_IMAGE_VIEW, name_);

    context.immediately([&](VkCommandBuffer commands) {
        VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
        barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
        barrier.oldLayout = VK_IMAGE_LAYOUT_UNDEFINED;
        barrier.newLayout = VK_IMAGE_LAYOUT_GENERAL;
        barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
        barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
        barrier.image = image;
        barrier.subresourceRange = viewInfo.subresourceRange;
        VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
        dependency.imageMemoryBarrierCount = 1;
        dependency.pImageMemoryBarriers = &barrier;
        api.vkCmdPipelineBarrier2(commands, &dependency);
    });
}

bool Image::isInteger() const {
    return texelFormat(format_).integer;
}

VkImageCreateInfo Image::describe(Context& context) {
    if (extent_.x < 1 || extent_.y < 1 || extent_.z < 1) {
        throw std::logic_error("image " + name_ + " has no texels");
    }
    VkFormatProperties properties{};
    vkGetPhysicalDeviceFormatProperties(context.physicalDevice(), format_, &properties);
    canStore_ = (properties.optimalTilingFeatures & VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT) != 0;
    canFilter_ = (properties.optimalTilingFeatures & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT) != 0;

    const glm::uvec3 extent(extent_);
    VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    info.imageType = dimensions_ == 3 ? VK_IMAGE_TYPE_3D : VK_IMAGE_TYPE_2D;
    info.format = format_;
    info.extent = {extent.x, extent.y, extent.z};
    info.mipLevels = 1;
    info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.tiling = VK_IMAGE_TILING_OPTIMAL;
    info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    if (canStore_) {
        info.usage |= VK_IMAGE_USAGE_STORAGE_BIT;
    }
    VkImageFormatProperties limits{};
    check(vkGetPhysicalDeviceImageFormatProperties(context.physicalDevice(), info.format, info.imageType, info.tiling,
                                                   info.usage, 0, &limits),
          "vkGetPhysicalDeviceImageFormatProperties");
    // lavapipe claims more for the width of a volume than its own device limit
    const std::uint32_t side =
        dimensions_ == 3 ? context.limits().maxImageDimension3D : context.limits().maxImageDimension2D;
    const VkExtent3D largest{std::min(limits.maxExtent.width, side), std::min(limits.maxExtent.height, side),
                             std::min(limits.maxExtent.depth, side)};
    if (extent.x > largest.width || extent.y > largest.height || extent.z > largest.depth) {
        throw Error(fmt::format("an image of {} texels is above the device's limit of {}", sizeText(info.extent),
                                sizeText(largest)),
                    name_, "use a coarser cloud or another device");
    }
    return info;
}

}  // namespace lumulus::gpu
