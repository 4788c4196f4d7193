#pragma once

#include <volk.h>

#include <span>
#include <string>
#include <vector>

namespace lumulus::gpu {

/// One resource that a shader declares in descriptor set 0.
struct BindingInfo {
    std::string name;  ///< the instance name where the GLSL gives one, else the name of the block
    std::uint32_t binding = 0;
    VkDescriptorType kind = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;  ///< or another that fits isBuffer() or an image
    int dimensions = 0;                                         ///< of an image: 2 or 3
    bool isArray = false;                                       ///< an array of 2D images (image2DArray)
    bool reads = true;                                          ///< false for `writeonly`
    bool writes = false;                                        ///< false for `readonly` and for sampled images

    /// Of bytes, or of texels (imageBuffer); else a storage image or a sampled one.
    bool isBuffer() const {
        return kind == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER || kind == VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER;
    }
};

/// What a compute shader says of itself.
struct Reflection {
    std::vector<BindingInfo> bindings;       ///< by number
    std::uint64_t pushBytes = 0;             ///< of the push-constant block, up to the end of its last member
    std::vector<std::uint32_t> constantIds;  ///< of all specialisation constants; an id may repeat
};

/// Reads the SPIR-V of a compute shader.
/// Throws std::logic_error for what Lumulus does not use: other sets than 0, arrays of resources, uniform blocks,
/// samplers apart from their images.
Reflection reflect(std::span<const std::uint32_t> spirv);

}  // namespace lumulus::gpu
