#include "gpu/program.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string_view>

namespace lumulus::gpu {

ProgramBase::ProgramBase(Context& context, std::string name, std::span<const std::uint32_t> spirv,
                         const std::vector<SpecConstant>& constants, std::uint32_t pushBytes,
                         std::uint32_t pushAlignment)
    : name_(std::move(name)), pushBytes_(pushBytes) {
    const Reflection reflection = reflect(spirv);
    bindings_ = reflection.bindings;
    const std::uint64_t shaderBytes = (reflection.pushBytes + pushAlignment - 1) / pushAlignment * pushAlignment;
    if (shaderBytes != pushBytes)
        throw std::logic_error(fmt::format("{}: the push constants have {} bytes in C++ and {} in the shader", name_,
                                           pushBytes, shaderBytes));
    for (const SpecConstant& constant : constants)
        if (std::ranges::count(reflection.constantIds, constant.id) == 0)
            throw std::logic_error(fmt::format("{}: the shader has no constant_id {}", name_, constant.id));
    const std::string_view code(reinterpret_cast<const char*>(spirv.data()), spirv.size_bytes());
    std::string key = fmt::format("{} {} {}", name_, code.size(), std::hash<std::string_view>()(code));
    for (const SpecConstant& constant : constants) key += fmt::format(" {}={}", constant.id, constant.value);
    std::weak_ptr<Pipeline>& shared = context.pipeline(key);
    if ((pipeline_ = shared.lock())) return;
    pipeline_ = std::make_shared<Pipeline>();
    createLayout(context);
    createPipeline(context, spirv, constants);
    shared = pipeline_;
}

void ProgramBase::createLayout(Context& context) {
    const VolkDeviceTable& api = context.api();
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    for (const BindingInfo& info : bindings_)
        bindings.push_back({info.binding, info.kind, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
    const VkDescriptorSetLayoutCreateInfo setInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, nullptr,
                                                  VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR,
                                                  static_cast<std::uint32_t>(bindings.size()), bindings.data()};
    pipeline_->setLayout = context.create(api.vkCreateDescriptorSetLayout, api.vkDestroyDescriptorSetLayout, setInfo,
                                          VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT, name_);
    VkDescriptorSetLayout setLayout = pipeline_->setLayout.get();
    const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, pushBytes_};
    const VkPipelineLayoutCreateInfo info{
        VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO, nullptr, 0, 1, &setLayout, pushBytes_ > 0 ? 1U : 0U, &range};
    pipeline_->layout = context.create(api.vkCreatePipelineLayout, api.vkDestroyPipelineLayout, info,
                                       VK_OBJECT_TYPE_PIPELINE_LAYOUT, name_);
}

void ProgramBase::createPipeline(Context& context, std::span<const std::uint32_t> spirv,
                                 const std::vector<SpecConstant>& constants) {
    const VolkDeviceTable& api = context.api();
    const VkShaderModuleCreateInfo moduleInfo{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, nullptr, 0,
                                              spirv.size_bytes(), spirv.data()};
    const Owned<VkShaderModule> module = context.create(api.vkCreateShaderModule, api.vkDestroyShaderModule, moduleInfo,
                                                        VK_OBJECT_TYPE_SHADER_MODULE, name_);
    std::vector<VkSpecializationMapEntry> entries;
    for (const SpecConstant& constant : constants) {
        const std::size_t offset = entries.size() * sizeof(SpecConstant) + offsetof(SpecConstant, value);
        entries.push_back({constant.id, static_cast<std::uint32_t>(offset), sizeof(constant.value)});
    }
    const VkSpecializationInfo specialization{static_cast<std::uint32_t>(entries.size()), entries.data(),
                                              constants.size() * sizeof(SpecConstant), constants.data()};
    VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    info.layout = pipeline_->layout.get();
    info.stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                  .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                  .module = module.get(),
                  .pName = "main",
                  .pSpecializationInfo = &specialization};
    VkPipeline pipeline = VK_NULL_HANDLE;
    check(api.vkCreateComputePipelines(context.handle(), VK_NULL_HANDLE, 1, &info, nullptr, &pipeline),
          "vkCreateComputePipelines");
    pipeline_->handle = Owned<VkPipeline>(pipeline, {context.handle(), api.vkDestroyPipeline});
    setObjectName(context.handle(), VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<std::uint64_t>(pipeline), name_);
}

}  // namespace lumulus::gpu
