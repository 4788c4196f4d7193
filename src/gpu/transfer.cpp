#include "gpu/transfer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace lumulus::gpu {
namespace {

void requireSize(bool fits, const Resource& resource, std::uint64_t has, std::uint64_t given) {
    if (fits) return;
    throw std::logic_error(fmt::format("{} has {} bytes, the transfer {}", resource.name(), has, given));
}

std::uint64_t sliceBytes(const ImageLevel& image) {
    return image.bytes() / static_cast<std::uint64_t>(image.slices());
}

/// The part of an image that so many bytes at an offset fill: whole slices, or rows of one slice.
VkBufferImageCopy regionOf(const ImageLevel& image, std::uint64_t offset, std::uint64_t bytes) {
    const glm::uvec3 extent(image.extent());
    const std::uint64_t slice = sliceBytes(image), row = slice / extent.y;
    const auto first = static_cast<std::uint32_t>(offset / slice);
    const auto count = static_cast<std::uint32_t>(std::max(bytes / slice, std::uint64_t{1}));
    const auto firstRow = static_cast<int>(offset % slice / row);
    const auto rows = static_cast<std::uint32_t>(std::min(bytes, slice) / row);
    const bool volume = image.image->dimensions() == 3;
    const auto layer = static_cast<std::uint32_t>(image.layer.value_or(0));
    const VkImageSubresourceLayers part{VK_IMAGE_ASPECT_COLOR_BIT, static_cast<std::uint32_t>(image.level),
                                        volume ? 0 : layer + first, volume ? 1 : count};
    const VkOffset3D corner{0, firstRow, volume ? static_cast<int>(layer + first) : 0};
    return {0, 0, 0, part, corner, {extent.x, rows, volume ? count : 1}};
}

/// `record` is called for pieces of at most `most` bytes: it records the copy of so many bytes at an offset, from the
/// staging buffer (const bytes) or to it.
template <class Byte, class Record>
void copyPieces(Context& context, std::span<Byte> bytes, std::uint64_t most, const Record& record) {
    const Buffer staging(context, "staging", std::min<std::uint64_t>(bytes.size(), most), Memory::host);
    std::byte* mapped = staging.mapped<std::byte>().data();
    for (std::uint64_t offset = 0; offset < bytes.size(); offset += most) {
        const auto piece = bytes.subspan(offset, std::min<std::uint64_t>(most, bytes.size() - offset));
        if constexpr (std::is_const_v<Byte>) std::memcpy(mapped, piece.data(), piece.size());
        context.immediately(
            [&](VkCommandBuffer commands) { record(commands, staging.handle(), offset, piece.size()); });
        if constexpr (!std::is_const_v<Byte>) std::memcpy(piece.data(), mapped, piece.size());
    }
    std::is_const_v<Byte> ? context.addUploaded(bytes.size()) : context.addDownloaded(bytes.size());
}

template <class Byte>
void copy(Context& context, const Buffer& buffer, std::span<Byte> bytes) {
    constexpr bool up = std::is_const_v<Byte>;
    requireSize(bytes.size() <= buffer.bytes(), buffer, buffer.bytes(), bytes.size());
    copyPieces(context, bytes, stagingBytes, [&](auto commands, auto staging, auto offset, auto count) {
        const VkBufferCopy region{up ? 0 : offset, up ? offset : 0, count};
        context.api().vkCmdCopyBuffer(commands, up ? staging : buffer.handle(), up ? buffer.handle() : staging, 1,
                                      &region);
    });
}

template <class Byte>
void copy(Context& context, const ImageLevel& level, std::span<Byte> bytes) {
    VkImage image = level.image->handle();
    requireSize(bytes.size() == level.bytes(), *level.image, level.bytes(), bytes.size());
    const auto rows = static_cast<std::uint64_t>(level.extent().y);
    const std::uint64_t slice = sliceBytes(level), unit = slice <= stagingBytes ? slice : slice / rows;
    const std::uint64_t most = std::max(stagingBytes / unit, std::uint64_t{1}) * unit;
    const std::uint64_t part = slice <= stagingBytes ? bytes.size() : slice;  // rows of one slice go together only
    for (std::uint64_t start = 0; start < bytes.size(); start += part)
        copyPieces(context, bytes.subspan(start, part), most, [&](auto list, auto staging, auto offset, auto count) {
            const VkBufferImageCopy region = regionOf(level, start + offset, count);
            if constexpr (std::is_const_v<Byte>)
                context.api().vkCmdCopyBufferToImage(list, staging, image, VK_IMAGE_LAYOUT_GENERAL, 1, &region);
            else
                context.api().vkCmdCopyImageToBuffer(list, image, VK_IMAGE_LAYOUT_GENERAL, staging, 1, &region);
        });
}

template <class Byte>
void copy(Context& context, const Image& image, std::span<Byte> bytes) {
    requireSize(bytes.size() == image.bytes(), image, image.bytes(), bytes.size());
    for (int i = 0; i < image.levels(); ++i) {
        const ImageLevel level = image.level(i);
        copy(context, level, bytes.first(level.bytes()));
        bytes = bytes.subspan(level.bytes());
    }
}

}  // namespace

template <class Place, class Byte>
void transfer(Context& context, const Place& place, std::span<Byte> bytes) {
    copy(context, place, bytes);
}

template void transfer(Context&, const Buffer&, std::span<std::byte>);
template void transfer(Context&, const Buffer&, std::span<const std::byte>);
template void transfer(Context&, const Image&, std::span<std::byte>);
template void transfer(Context&, const Image&, std::span<const std::byte>);
template void transfer(Context&, const ImageLevel&, std::span<std::byte>);
template void transfer(Context&, const ImageLevel&, std::span<const std::byte>);

}  // namespace lumulus::gpu
