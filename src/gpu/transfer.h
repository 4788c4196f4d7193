#pragma once

#include <cstddef>
#include <cstdint>
#include <ranges>
#include <span>
#include <vector>

#include "gpu/memory.h"

/// One-time copies between host and device. Each waits until it is done, ordered after all work submitted before.
/// Device memory goes through a staging buffer of at most `stagingBytes`.
namespace lumulus::gpu {

inline constexpr std::uint64_t stagingBytes = 16ULL << 20U;

/// Writes the first `bytes.size()` bytes of the buffer. std::logic_error where they do not fit.
void uploadBytes(Context& context, Buffer& to, std::span<const std::byte> bytes);
/// Writes all texels, tightly packed, x fastest. std::logic_error where the sizes differ.
void uploadBytes(Context& context, Image& to, std::span<const std::byte> bytes);
/// Reads the first `bytes.size()` bytes of the buffer.
void downloadBytes(Context& context, const Buffer& from, std::span<std::byte> bytes);
/// Reads all texels, tightly packed, x fastest. std::logic_error where the sizes differ.
void downloadBytes(Context& context, const Image& from, std::span<std::byte> bytes);

/// Uploads a vector, array or span to a Buffer or an Image.
template <class Resource, std::ranges::contiguous_range Values>
void upload(Context& context, Resource& to, const Values& values) {
    uploadBytes(context, to, std::as_bytes(std::span(std::ranges::data(values), std::ranges::size(values))));
}

/// Downloads as many whole values of type T as a Buffer or an Image holds.
template <class T, class Resource>
std::vector<T> download(Context& context, const Resource& from) {
    std::vector<T> values(from.bytes() / sizeof(T));
    downloadBytes(context, from, std::as_writable_bytes(std::span(values)));
    return values;
}

}  // namespace lumulus::gpu
