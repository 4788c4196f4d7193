#include "gpu/transfer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace lumulus::gpu {
namespace {

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
