#pragma once

#include <volk.h>

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lumulus::gpu {

/// One resource that a shader declares in descriptor set 0.
struct BindingInfo {
    std::string name;  ///< the instance name where the GLSL gives one, else the name of the block
    std::uint32_t binding = 0;
    VkDescriptorType kind = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;  ///< or STORAGE_IMAGE or COMBINED_IMAGE_SAMPLER
    int dimensions = 0;                                         ///< of an image: 2 or 3
    bool reads = true;                                          ///< false for `writeonly`
    bool writes = false;                                        ///< false for `readonly` and for sampled images
};

struct MemberLayout {
    std::string name;
    std::uint64_t offset = 0;
    std::uint64_t bytes = 0;  ///< 0 for an array without a size

    bool operator==(const MemberLayout&) const = default;
};

/// How a struct lies in memory, to be compared with sizeof and offsetof.
struct StructLayout {
    std::string name;
    std::uint64_t bytes = 0;  ///< rounded up to the alignment of the largest scalar in it, as sizeof is
    std::vector<MemberLayout> members;
};

/// What a compute shader says of itself.
struct Reflection {
    std::vector<BindingInfo> bindings;       ///< by number
    std::uint64_t pushBytes = 0;             ///< size of the push-constant block, rounded as StructLayout
    std::vector<std::uint32_t> constantIds;  ///< of all specialisation constants; an id may repeat
    std::vector<StructLayout> structs;       ///< blocks and every struct nested in them

    /// The struct or block of that type name. Throws std::logic_error where no binding or push constant has it.
    const StructLayout& layout(std::string_view name) const;
};

/// Reads the SPIR-V of a compute shader.
/// Throws std::logic_error for what Lumulus does not use: other sets than 0, arrays of resources, uniform blocks,
/// samplers apart from their images.
Reflection reflect(std::span<const std::uint32_t> spirv);

}  // namespace lumulus::gpu
