#include "gpu/context.h"

#include <stdexcept>

#include "base/error.h"
#include "gpu/requirements.h"
#include "gpu/result.h"

namespace lumulus::gpu {

Context::LogicalDevice::~LogicalDevice() {
    if (handle != VK_NULL_HANDLE) {
        api.vkDestroyDevice(handle, nullptr);
    }
}

Context::Context(const ContextOptions& options) : instance_(options.validation) {
    selectPhysicalDevice(options.device);
    createDevice();
    createSharedObjects();
}

Context::~Context() {
    // no check: a lost device is idle as well
    device_.api.vkDeviceWaitIdle(device_.handle);
}

void Context::selectPhysicalDevice(const std::string& wanted) {
    const std::vector<VkPhysicalDevice> devices = instance_.physicalDevices();
    const std::vector<DeviceInfo> infos = describeDevices(devices);
    std::string missing;
    std::string best;
    for (const std::uint32_t index : chooseDevices(infos, wanted)) {
        const Capabilities capabilities = queryCapabilities(devices[index]);
        const std::string lack = missingRequirement(capabilities);
        if (lack.empty()) {
            physical_ = devices[index];
            info_ = infos[index];
            queueFamily_ = *capabilities.queueFamily;
            timestampBits_ = capabilities.timestampBits;
            return;
        }
        if (best.empty()) {
            best = infos[index].name;
            missing = lack;
        }
    }
    throw Error("the Vulkan device lacks " + missing, best,
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
    VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    queue.queueFamilyIndex = queueFamily_;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    const char* extension = VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME;
    VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
    info.pNext = features.chain();
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    info.enabledExtensionCount = 1;
    info.ppEnabledExtensionNames = &extension;
    check(vkCreateDevice(physical_, &info, nullptr, &device_.handle), "vkCreateDevice");
    volkLoadDeviceTable(&device_.api, device_.handle);
    device_.api.vkGetDeviceQueue(device_.handle, queueFamily_, 0, &queue_);
}

void Context::createSharedObjects() {
    const VolkDeviceTable& api = device_.api;
    const VkPipelineCacheCreateInfo cache{VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
    pipelineCache_ = create(api.vkCreatePipelineCache, api.vkDestroyPipelineCache, cache, VK_OBJECT_TYPE_PIPELINE_CACHE,
                            "pipelines");
    VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    pool.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
    pool.queueFamilyIndex = queueFamily_;
    immediatePool_ = create(api.vkCreateCommandPool, api.vkDestroyCommandPool, pool, VK_OBJECT_TYPE_COMMAND_POOL,
                            "immediate commands");
    const VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    immediateFence_ = create(api.vkCreateFence, api.vkDestroyFence, fence, VK_OBJECT_TYPE_FENCE, "immediate commands");
    for (std::size_t i = 0; i < samplerCount; ++i) {
        samplers_[i] = create(api.vkCreateSampler, api.vkDestroySampler,
                              samplerInfo(static_cast<Sampler>(i + 1), false), VK_OBJECT_TYPE_SAMPLER, "sampler");
    }
    integerSampler_ = create(api.vkCreateSampler, api.vkDestroySampler, samplerInfo(Sampler::nearest, true),
                             VK_OBJECT_TYPE_SAMPLER, "integer sampler");
}

VkSampler Context::sampler(Sampler kind, bool integerTexels) const {
    if (kind == Sampler::none || (integerTexels && kind != Sampler::nearest)) {
        throw std::logic_error("no such sampler: integer texels allow only Sampler::nearest");
    }
    return integerTexels ? integerSampler_.get() : samplers_[static_cast<std::size_t>(kind) - 1].get();
}

void Context::setName(VkObjectType type, std::uint64_t object, const std::string& name) const {
    if (instance_.hasDebugUtils()) {
        VkDebugUtilsObjectNameInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT};
        info.objectType = type;
        info.objectHandle = object;
        info.pObjectName = name.c_str();
        check(vkSetDebugUtilsObjectNameEXT(device_.handle, &info), "vkSetDebugUtilsObjectNameEXT");
    }
}

void Context::immediately(const std::function<void(VkCommandBuffer)>& record) {
    const VolkDeviceTable& api = device_.api;
    check(api.vkResetCommandPool(device_.handle, immediatePool_.get(), VK_COMMAND_POOL_RESET_RELEASE_RESOURCES_BIT),
          "vkResetCommandPool");
    VkCommandBufferAllocateInfo allocateInfo{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    allocateInfo.commandPool = immediatePool_.get();
    allocateInfo.commandBufferCount = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    check(api.vkAllocateCommandBuffers(device_.handle, &allocateInfo, &commands), "vkAllocateCommandBuffers");
    VkCommandBufferBeginInfo beginInfo{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    beginInfo.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check(api.vkBeginCommandBuffer(commands, &beginInfo), "vkBeginCommandBuffer");
    recordFullBarrier(commands);
    record(commands);
    recordFullBarrier(commands);
    check(api.vkEndCommandBuffer(commands), "vkEndCommandBuffer");
    submit(commands, immediateFence_.get());
    waitFor(immediateFence_.get());
    api.vkFreeCommandBuffers(device_.handle, immediatePool_.get(), 1, &commands);
}

void Context::submit(VkCommandBuffer commands, VkFence fence) const {
    VkCommandBufferSubmitInfo buffer{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
    buffer.commandBuffer = commands;
    VkSubmitInfo2 info{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
    info.commandBufferInfoCount = 1;
    info.pCommandBufferInfos = &buffer;
    check(device_.api.vkQueueSubmit2(queue_, 1, &info, fence), "vkQueueSubmit2");
}

void Context::waitFor(VkFence fence) const {
    const VolkDeviceTable& api = device_.api;
    check(api.vkWaitForFences(device_.handle, 1, &fence, VK_TRUE, ~0ULL), "vkWaitForFences");
    check(api.vkResetFences(device_.handle, 1, &fence), "vkResetFences");
}

void Context::recordFullBarrier(VkCommandBuffer commands) const {
    VkMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_2_HOST_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &barrier;
    device_.api.vkCmdPipelineBarrier2(commands, &dependency);
}

}  // namespace lumulus::gpu
