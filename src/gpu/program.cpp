#include "gpu/program.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace lumulus::gpu {
namespace {

VkDescriptorType descriptorType(BindingKind kind) {
    switch (kind) {
        case BindingKind::storageImage:
            return VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
        case BindingKind::sampledImage:
            return VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
        case BindingKind::storageBuffer:
            break;
    }
    return VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
}

}  // namespace

ProgramBase::ProgramBase(Context& context, std::string name, std::span<const std::uint32_t> spirv,
                         const std::vector<SpecConstant>& constants, std::uint64_t pushBytes)
    : name_(std::move(name)), pushBytes_(static_cast<std::uint32_t>(pushBytes)) {
    const Reflection reflection = reflect(spirv);
    bindings_ = reflection.bindings;
    if (reflection.pushBytes != pushBytes) {
        throw std::logic_error(fmt::format("{}: the push constants have {} bytes in C++ and {} in the shader", name_,
                                           pushBytes, reflection.pushBytes));
    }
    specialise(reflection, constants);
    createLayout(context);
    createPipeline(context, spirv, constants);
}

void ProgramBase::specialise(const Reflection& reflection, const std::vector<SpecConstant>& constants) {
    workgroup_ = reflection.workgroup;
    for (const SpecConstant& constant : constants) {
        const std::vector<std::uint32_t>& known = reflection.constantIds;
        if (std::find(known.begin(), known.end(), constant.id) == known.end()) {
            throw std::logic_error(fmt::format("{}: the shader has no constant_id {}", name_, constant.id));
        }
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (reflection.workgroupId[axis] == constant.id) {
                workgroup_[static_cast<int>(axis)] = constant.value;
            }
        }
    }
}

void ProgramBase::createLayout(Context& context) {
    const VolkDeviceTable& api = context.api();
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    for (const BindingInfo& info : bindings_) {
        bindings.push_back({info.binding, descriptorType(info.kind), 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
    }
    VkDescriptorSetLayoutCreateInfo setInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    setInfo.flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR;
    setInfo.bindingCount = static_cast<std::uint32_t>(bindings.size());
    setInfo.pBindings = bindings.data();
    setLayout_ = context.create(api.vkCreateDescriptorSetLayout, api.vkDestroyDescriptorSetLayout, setInfo,
                                VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT, name_);

    VkDescriptorSetLayout setLayout = setLayout_.get();
    const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, pushBytes_};
    VkPipelineLayoutCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    info.setLayoutCount = 1;
    info.pSetLayouts = &setLayout;
    info.pushConstantRangeCount = pushBytes_ > 0 ? 1 : 0;
    info.pPushConstantRanges = &range;
    layout_ = context.create(api.vkCreatePipelineLayout, api.vkDestroyPipelineLayout, info,
                             VK_OBJECT_TYPE_PIPELINE_LAYOUT, name_);
}

void ProgramBase::createPipeline(Context& context, std::span<const std::uint32_t> spirv,
                                 const std::vector<SpecConstant>& constants) {
    const VolkDeviceTable& api = context.api();
    VkShaderModuleCreateInfo moduleInfo{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    moduleInfo.codeSize = spirv.size_bytes();
    moduleInfo.pCode = spirv.data();
    const Owned<VkShaderModule> module = context.create(api.vkCreateShaderModule, api.vkDestroyShaderModule, moduleInfo,
                                                        VK_OBJECT_TYPE_SHADER_MODULE, name_);

    std::vector<VkSpecializationMapEntry> entries;
    for (std::size_t i = 0; i < constants.size(); ++i) {
        entries.push_back({constants[i].id,
                           static_cast<std::uint32_t>(i * sizeof(SpecConstant) + offsetof(SpecConstant, value)),
                           sizeof(std::uint32_t)});
    }
    const VkSpecializationInfo specialization{static_cast<std::uint32_t>(entries.size()), entries.data(),
                                              constants.size() * sizeof(SpecConstant), constants.data()};
    VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    info.layout = layout_.get();
    info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = module.get();
    info.stage.pName = "main";
    info.stage.pSpecializationInfo = &specialization;
    VkPipeline pipeline = VK_NULL_HANDLE;
    check(api.vkCreateComputePipelines(context.handle(), context.pipelineCache(), 1, &info, nullptr, &pipeline),
          "vkCreateComputePipelines");
    pipeline_ = {context.handle(), pipeline, api.vkDestroyPipeline};
    context.setName(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<std::uint64_t>(pipeline), name_);
}

}  // namespace lumulus::gpu
