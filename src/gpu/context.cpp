#include "gpu/context.h"

#include <stdexcept>

#include "base/error.h"

namespace lumulus::gpu {

Context::Context(const ContextOptions& options) : instance_(options.validation) {
    selectPhysicalDevice(options.device);
    createDevice();
    immediate_ = makeCommandBuffer("immediate commands");
    VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    const auto createSampler = [&](VkFilter filter, VkSamplerAddressMode outside, VkBorderColor border) {
        info.magFilter = info.minFilter = filter;
        info.addressModeU = info.addressModeV = info.addressModeW = outside;
        info.borderColor = border;
        return create(api_.vkCreateSampler, api_.vkDestroySampler, info, VK_OBJECT_TYPE_SAMPLER, "sampler");
    };
    constexpr VkSamplerAddressMode border = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER;
    constexpr VkBorderColor zero = VK_BORDER_COLOR_FLOAT_TRANSPARENT_BLACK;
    nearest_ = createSampler(VK_FILTER_NEAREST, border, zero);
    integer_ = createSampler(VK_FILTER_NEAREST, border, VK_BORDER_COLOR_INT_TRANSPARENT_BLACK);
    linear_ = createSampler(VK_FILTER_LINEAR, border, zero);
    linearClamp_ = createSampler(VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, zero);
}

Context::~Context() {
    api_.vkDeviceWaitIdle(handle());  // no check: a lost device is idle as well
}

void Context::selectPhysicalDevice(const std::string& wanted) {
    const std::vector<VkPhysicalDevice> devices = instance_.physicalDevices();
    const std::vector<DeviceInfo> infos = describeDevices(devices);
    std::string missing;  // of the best device
    for (const std::uint32_t index : chooseDevices(infos, wanted)) {
        const Capabilities capabilities = queryCapabilities(devices[index]);
        const std::string lack = missingRequirement(capabilities);
        if (missing.empty()) {
            missing = lack;
            info_ = infos[index];
        }
        if (!lack.empty()) continue;
        info_ = infos[index];
        physical_ = devices[index];
        queueFamily_ = *capabilities.queueFamily;
        timestampBits_ = capabilities.timestampBits;
        return;
    }
    throw Error("the Vulkan device lacks " + missing, info_.name,
                "choose another device, or install mesa-vulkan-drivers to render on the CPU");
}

void Context::createDevice() {
    VkPhysicalDeviceMaintenance3Properties maintenance{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES};
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &maintenance, {}};
    vkGetPhysicalDeviceProperties2(physical_, &properties);
    properties_ = properties.properties;
    maxAllocationBytes_ = maintenance.maxMemoryAllocationSize;

    Features features = requiredFeatures();
    const float priority = 1.0F;
    const VkDeviceQueueCreateInfo queue{
        VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, nullptr, 0, queueFamily_, 1, &priority};
    const char* extension = VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME;
    VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, features.chain()};
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    info.enabledExtensionCount = 1;
    info.ppEnabledExtensionNames = &extension;
    VkDevice device = VK_NULL_HANDLE;
    check(vkCreateDevice(physical_, &info, nullptr, &device), "vkCreateDevice");
    volkLoadDeviceTable(&api_, device);
    device_.reset(device);
    api_.vkGetDeviceQueue(device, queueFamily_, 0, &queue_);
}

VkSampler Context::sampler(Sampler kind, bool integerTexels) const {
    if (kind == Sampler::none) return VK_NULL_HANDLE;
    if (integerTexels && kind != Sampler::nearest)
        throw std::logic_error("no such sampler: integer texels allow only Sampler::nearest");
    if (kind == Sampler::nearest) return integerTexels ? integer_.get() : nearest_.get();
    return kind == Sampler::linear ? linear_.get() : linearClamp_.get();
}

void Context::setName(VkObjectType type, std::uint64_t object, const std::string& name) const {
    const VkDebugUtilsObjectNameInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT, nullptr, type, object,
                                             name.c_str()};
    check(vkSetDebugUtilsObjectNameEXT(handle(), &info), "vkSetDebugUtilsObjectNameEXT");
}

CommandBuffer Context::makeCommandBuffer(const std::string& name) const {
    CommandBuffer made;
    const VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr, 0, queueFamily_};
    made.pool = create(api_.vkCreateCommandPool, api_.vkDestroyCommandPool, pool, VK_OBJECT_TYPE_COMMAND_POOL, name);
    const VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    made.fence = create(api_.vkCreateFence, api_.vkDestroyFence, fence, VK_OBJECT_TYPE_FENCE, name);
    const VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr, made.pool.get(),
                                           VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
    check(api_.vkAllocateCommandBuffers(handle(), &info, &made.handle), "vkAllocateCommandBuffers");
    return made;
}

void Context::begin(const CommandBuffer& commands) const {
    check(api_.vkResetCommandPool(handle(), commands.pool.get(), 0), "vkResetCommandPool");
    const VkCommandBufferBeginInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, nullptr,
                                        VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    check(api_.vkBeginCommandBuffer(commands.handle, &info), "vkBeginCommandBuffer");
    recordFullBarrier(commands.handle);
}

void Context::submit(const CommandBuffer& commands) const {
    recordFullBarrier(commands.handle);
    check(api_.vkEndCommandBuffer(commands.handle), "vkEndCommandBuffer");
    VkSubmitInfo info{VK_STRUCTURE_TYPE_SUBMIT_INFO};
    info.commandBufferCount = 1;
    info.pCommandBuffers = &commands.handle;
    check(api_.vkQueueSubmit(queue_, 1, &info, commands.fence.get()), "vkQueueSubmit");
}

void Context::wait(const CommandBuffer& commands) const {
    VkFence fence = commands.fence.get();
    check(api_.vkWaitForFences(handle(), 1, &fence, VK_TRUE, ~0ULL), "vkWaitForFences");
    check(api_.vkResetFences(handle(), 1, &fence), "vkResetFences");
}

void Context::recordFullBarrier(VkCommandBuffer commands) const {
    const VkMemoryBarrier2 barrier{
        .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
        .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
        .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
        .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_2_HOST_BIT,
        .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT,
    };
    const VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO, nullptr, 0, 1, &barrier};
    api_.vkCmdPipelineBarrier2(commands, &dependency);
}

}  // namespace lumulus::gpu
