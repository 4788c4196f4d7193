#pragma once

#include <glm/glm.hpp>

#include "gpu/commands.h"
#include "gpu/groups.h"
#include "gpu/transfer.h"
#include "shared/fog.h"

namespace lumulus::fog {

/// What every filter reads: the light of a layer (alpha: how much of the pixel it covers), its distances (one texel
/// where all are the same) and the media.
struct LayerInputs {
    const gpu::Image& radiance;
    const gpu::Image& distances;
    const gpu::Buffer& media;
    shared::FogPush push;

    std::vector<gpu::Binding> bindings() const {
        return {{"radiance", radiance, gpu::Sampler::nearest},
                {"distances", distances, gpu::Sampler::nearest},
                {"Media", media}};
    }
};

/// An image of zeros: what no pass writes, between the levels of a pyramid, must not hold what was there before.
inline gpu::Image emptyImage(gpu::Context& context, const char* name, const glm::ivec2& extent, VkFormat format) {
    gpu::Image image(context, name, extent, format);
    gpu::clear(context, image);
    return image;
}

/// RGB and a fourth value of each pixel. Whole floats: half ones overflow at a radiance of 65504.
inline constexpr VkFormat lightFormat = VK_FORMAT_R32G32B32A32_SFLOAT;

}  // namespace lumulus::fog
