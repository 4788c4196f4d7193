#include "gpu/reflection.h"

#include <algorithm>
#include <spirv_cross.hpp>
#include <stdexcept>

namespace lumulus::gpu {
namespace {

using spirv_cross::Compiler;

void require(bool holds, const std::string& what) {
    if (!holds) throw std::logic_error("SPIR-V reflection: " + what);
}

/// `flags` are the decorations: of a block, the ones that all its members have.
BindingInfo readBinding(const Compiler& compiler, const spirv_cross::Resource& resource, VkDescriptorType kind,
                        const spirv_cross::Bitset& flags) {
    const std::string& instance = compiler.get_name(resource.id);
    BindingInfo info{.name = instance.empty() ? compiler.get_name(resource.base_type_id) : instance, .kind = kind};
    info.binding = compiler.get_decoration(resource.id, spv::DecorationBinding);
    info.reads = !flags.get(spv::DecorationNonReadable);
    info.writes = kind != VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER && !flags.get(spv::DecorationNonWritable);
    require(compiler.get_decoration(resource.id, spv::DecorationDescriptorSet) == 0,
            info.name + " is not in descriptor set 0");
    const spirv_cross::SPIRType& type = compiler.get_type(resource.type_id);
    require(type.array.empty(), info.name + " is an array of resources");
    if (info.isBuffer()) return info;
    require(type.image.dim == spv::Dim2D || type.image.dim == spv::Dim3D,
            info.name + " is neither a 2D nor a 3D image");
    info.dimensions = type.image.dim == spv::Dim3D ? 3 : 2;
    info.isArray = type.image.arrayed;
    return info;
}

Reflection read(const Compiler& compiler) {
    const spirv_cross::ShaderResources resources = compiler.get_shader_resources();
    require(resources.uniform_buffers.empty() && resources.separate_images.empty() &&
                resources.separate_samplers.empty() && resources.acceleration_structures.empty(),
            "uniform blocks and separate samplers are not used here");
    Reflection result;
    std::vector<BindingInfo>& bindings = result.bindings;
    for (const auto& buffer : resources.storage_buffers)
        bindings.push_back(readBinding(compiler, buffer, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                       compiler.get_buffer_block_flags(buffer.id)));
    for (const auto& image : resources.storage_images) {
        const bool texels = compiler.get_type(image.type_id).image.dim == spv::DimBuffer;
        bindings.push_back(readBinding(
            compiler, image, texels ? VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
            compiler.get_decoration_bitset(image.id)));
    }
    for (const auto& image : resources.sampled_images)
        bindings.push_back(readBinding(compiler, image, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, {}));
    std::ranges::sort(bindings, {}, &BindingInfo::binding);
    for (const auto& block : resources.push_constant_buffers)
        result.pushBytes = compiler.get_declared_struct_size(compiler.get_type(block.base_type_id));
    for (const auto& constant : compiler.get_specialization_constants())
        result.constantIds.push_back(constant.constant_id);
    return result;
}

}  // namespace

Reflection reflect(std::span<const std::uint32_t> spirv) {
    try {
        return read(Compiler(spirv.data(), spirv.size()));
    } catch (const spirv_cross::CompilerError& error) {
        throw std::logic_error(std::string("SPIR-V reflection: ") + error.what());
    }
}

}  // namespace lumulus::gpu
