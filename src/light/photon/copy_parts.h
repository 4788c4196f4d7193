#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gpu/context.h"
#include "gpu/memory.h"

namespace lumulus::photon {

/// A part of a buffer that goes to a place of another one [bytes].
struct BufferPart {
    std::uint64_t from = 0, to = 0, bytes = 0;
};

/// Copies parts of a buffer on the device, at once: ordered after all work submitted before. Both have to hold them.
inline void copyParts(gpu::Context& context, const gpu::Buffer& from, const gpu::Buffer& to,
                      std::span<const BufferPart> parts) {
    std::vector<VkBufferCopy> regions;
    for (const BufferPart& part : parts)
        if (part.bytes > 0) regions.push_back({part.from, part.to, part.bytes});
    if (regions.empty()) return;
    context.immediately([&](VkCommandBuffer commands) {
        context.api().vkCmdCopyBuffer(commands, from.handle(), to.handle(), static_cast<std::uint32_t>(regions.size()),
                                      regions.data());
    });
}

}  // namespace lumulus::photon
