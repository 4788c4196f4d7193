#pragma once

#include <ranges>

#include "gpu/memory.h"

/// One-time copies between host and device through a staging buffer of at most `stagingBytes` or one row. Each waits
/// until it is done, ordered after all work submitted before. A buffer is written or read from its start, as far as the
/// bytes go (std::logic_error where it has not as many). Of an image go all texels, tightly packed: x fastest, then y,
/// then z or the layers, then the levels; or those of one level, layer or slice of it (std::logic_error where the
/// sizes differ).
namespace lumulus::gpu {

inline constexpr std::uint64_t stagingBytes = 16ULL << 20U;

/// Uploads const bytes, downloads to others; `place` is a Buffer, an Image or an ImageLevel.
template <class Place, class Byte>
void transfer(Context& context, const Place& place, std::span<Byte> bytes);

/// Uploads a vector, array or span to a Buffer, an Image or an ImageLevel.
template <class To, std::ranges::contiguous_range Values>
void upload(Context& context, To&& to, const Values& values) {
    transfer(context, to, std::as_bytes(std::span(std::ranges::data(values), std::ranges::size(values))));
}

/// Downloads as many whole values of type T as a Buffer, an Image or an ImageLevel holds.
template <class T, class From>
std::vector<T> download(Context& context, const From& from) {
    std::vector<T> values(from.bytes() / sizeof(T));
    transfer(context, from, std::as_writable_bytes(std::span(values)));
    return values;
}

/// A device buffer with these contents.
template <class Values>
Buffer filledBuffer(Context& context, const char* name, const Values& values) {
    Buffer buffer(context, name, values.size() * sizeof(values[0]), Memory::device);
    if (!values.empty()) upload(context, buffer, values);
    return buffer;
}

/// Sets all texels to zero, on the device and at once: nothing goes up from the host. Ordered after all work submitted
/// before.
inline void clear(Context& context, Image& image) {
    context.immediately([&](VkCommandBuffer commands) {
        const VkClearColorValue zero{};
        const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, VK_REMAINING_MIP_LEVELS, 0,
                                          VK_REMAINING_ARRAY_LAYERS};
        context.api().vkCmdClearColorImage(commands, image.handle(), VK_IMAGE_LAYOUT_GENERAL, &zero, 1, &all);
    });
}

}  // namespace lumulus::gpu
