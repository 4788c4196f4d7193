#pragma once

#include "gpu/memory.h"

namespace lumulus::gpu {

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
