#pragma once

#include <volk.h>

#include <cstddef>

namespace lumulus::gpu {

/// How a shader reads an image. Coordinates run from 0 to 1 over the image.
enum class Sampler {
    none,          ///< a storage image: imageLoad and imageStore
    nearest,       ///< outside the image: 0
    linear,        ///< outside the image: 0
    linearMirror,  ///< outside the image: mirrored at the edge
    linearClamp,   ///< outside the image: the texel at the edge
};
inline constexpr std::size_t samplerCount = 4;  ///< without `none`

/// The create-info of a sampler. An integer image allows only Sampler::nearest.
VkSamplerCreateInfo samplerInfo(Sampler kind, bool integerTexels);

}  // namespace lumulus::gpu
