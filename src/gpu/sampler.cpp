#include "gpu/sampler.h"

namespace lumulus::gpu {

VkSamplerCreateInfo samplerInfo(Sampler kind, bool integerTexels) {
    const VkFilter filter = kind == Sampler::nearest ? VK_FILTER_NEAREST : VK_FILTER_LINEAR;
    VkSamplerAddressMode outside = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER;
    if (kind == Sampler::linearMirror) {
        outside = VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT;
    } else if (kind == Sampler::linearClamp) {
        outside = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    }
    VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    info.magFilter = filter;
    info.minFilter = filter;
    info.addressModeU = outside;
    info.addressModeV = outside;
    info.addressModeW = outside;
    info.borderColor = integerTexels ? VK_BORDER_COLOR_INT_TRANSPARENT_BLACK : VK_BORDER_COLOR_FLOAT_TRANSPARENT_BLACK;
    return info;
}

}  // namespace lumulus::gpu
