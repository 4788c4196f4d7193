#include "gpu/transfer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <stdexcept>

namespace lumulus::gpu {
namespace {

void requireSize(bool fits, const std::string& name, std::uint64_t has, std::uint64_t given) {
    if (!fits) {
        throw std::logic_error(fmt::format("{} has {} bytes, the transfer {}", name, has, given));
    }
}

Buffer makeStaging(Context& context, std::uint64_t bytes) {
    return {context, "staging", std::min(bytes, stagingBytes), Memory::host};
}

/// Calls `move` with each chunk of an array of bytes.
void inChunks(std::uint64_t bytes, const std::function<void(std::uint64_t offset, std::uint64_t count)>& move) {
    for (std::uint64_t offset = 0; offset < bytes; offset += stagingBytes) {
        move(offset, std::min(stagingBytes, bytes - offset));
    }
}

/// Calls `move` with each chunk of an image: as many whole slices as fit, else as many whole rows of a slice.
void inChunks(const Image& image,
              const std::function<void(std::uint64_t offset, const VkBufferImageCopy& region)>& move) {
    const glm::uvec3 extent(image.extent());
    const std::uint64_t rowBytes = extent.x * texelBytes(image.format());
    const std::uint64_t sliceBytes = rowBytes * extent.y;
    const bool whole = sliceBytes <= stagingBytes;
    const std::uint32_t slices = whole ? static_cast<std::uint32_t>(stagingBytes / sliceBytes) : 1;
    const std::uint32_t rows = whole ? extent.y : static_cast<std::uint32_t>(stagingBytes / rowBytes);
    for (std::uint32_t z = 0; z < extent.z; z += slices) {
        for (std::uint32_t y = 0; y < extent.y; y += rows) {
            VkBufferImageCopy region{};
            region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
            region.imageOffset = {0, static_cast<std::int32_t>(y), static_cast<std::int32_t>(z)};
            region.imageExtent = {extent.x, std::min(rows, extent.y - y), std::min(slices, extent.z - z)};
            move(z * sliceBytes + y * rowBytes, region);
        }
    }
}

std::uint64_t regionBytes(const Image& image, const VkBufferImageCopy& region) {
    const VkExtent3D& extent = region.imageExtent;
    return texelBytes(image.format()) * extent.width * extent.height * extent.depth;
}

}  // namespace

void uploadBytes(Context& context, Buffer& to, std::span<const std::byte> bytes) {
    requireSize(bytes.size() <= to.bytes(), to.name(), to.bytes(), bytes.size());
    if (bytes.empty()) {
        return;
    }
    if (to.isMapped()) {
        std::memcpy(to.mapped<std::byte>().data(), bytes.data(), bytes.size());
        return;
    }
    Buffer staging = makeStaging(context, bytes.size());
    inChunks(bytes.size(), [&](std::uint64_t offset, std::uint64_t count) {
        std::memcpy(staging.mapped<std::byte>().data(), &bytes[offset], count);
        context.immediately([&](VkCommandBuffer commands) {
            const VkBufferCopy region{0, offset, count};
            context.api().vkCmdCopyBuffer(commands, staging.handle(), to.handle(), 1, &region);
        });
    });
}

void downloadBytes(Context& context, const Buffer& from, std::span<std::byte> bytes) {
    requireSize(bytes.size() <= from.bytes(), from.name(), from.bytes(), bytes.size());
    if (bytes.empty()) {
        return;
    }
    if (from.isMapped()) {
        std::memcpy(bytes.data(), from.mapped<std::byte>().data(), bytes.size());
        return;
    }
    const Buffer staging = makeStaging(context, bytes.size());
    inChunks(bytes.size(), [&](std::uint64_t offset, std::uint64_t count) {
        context.immediately([&](VkCommandBuffer commands) {
            const VkBufferCopy region{offset, 0, count};
            context.api().vkCmdCopyBuffer(commands, from.handle(), staging.handle(), 1, &region);
        });
        std::memcpy(&bytes[offset], staging.mapped<std::byte>().data(), count);
    });
}

void uploadBytes(Context& context, Image& to, std::span<const std::byte> bytes) {
    requireSize(bytes.size() == to.bytes(), to.name(), to.bytes(), bytes.size());
    Buffer staging = makeStaging(context, to.bytes());
    inChunks(to, [&](std::uint64_t offset, const VkBufferImageCopy& region) {
        std::memcpy(staging.mapped<std::byte>().data(), &bytes[offset], regionBytes(to, region));
        context.immediately([&](VkCommandBuffer commands) {
            context.api().vkCmdCopyBufferToImage(commands, staging.handle(), to.handle(), VK_IMAGE_LAYOUT_GENERAL, 1,
                                                 &region);
        });
    });
}

void downloadBytes(Context& context, const Image& from, std::span<std::byte> bytes) {
    requireSize(bytes.size() == from.bytes(), from.name(), from.bytes(), bytes.size());
    const Buffer staging = makeStaging(context, from.bytes());
    inChunks(from, [&](std::uint64_t offset, const VkBufferImageCopy& region) {
        context.immediately([&](VkCommandBuffer commands) {
            context.api().vkCmdCopyImageToBuffer(commands, from.handle(), VK_IMAGE_LAYOUT_GENERAL, staging.handle(), 1,
                                                 &region);
        });
        std::memcpy(&bytes[offset], staging.mapped<std::byte>().data(), regionBytes(from, region));
    });
}

}  // namespace lumulus::gpu
