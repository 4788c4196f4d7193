#include "gpu/context.h"

#include "base/error.h"

namespace lumulus::gpu {

Context::Context(const ContextOptions& options) : instance_(options.validation) {
    selectPhysicalDevice(options.device);
    openDevice();
    immediate_ = makeCommandBuffer("immediate commands");
    const auto makeSampler = [&](VkFilter filter, VkSamplerAddressMode outside) {
        VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
        info.magFilter = info.minFilter = filter;
        info.mipmapMode = filter == VK_FILTER_LINEAR ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST;
        info.maxLod = VK_LOD_CLAMP_NONE;
        info.addressModeU = info.addressModeV = info.addressModeW = outside;
        info.borderColor = VK_BORDER_COLOR_FLOAT_TRANSPARENT_BLACK;
        return create(api_.vkCreateSampler, api_.vkDestroySampler, info, VK_OBJECT_TYPE_SAMPLER, "sampler");
    };
    samplers_ = {Owned<VkSampler>(), makeSampler(VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER),
                 makeSampler(VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER),
                 makeSampler(VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE)};
}

Context::~Context() {
    api_.vkDeviceWaitIdle(handle());  // no check: a lost device is idle as well
}

void Context::selectPhysicalDevice(const std::string& wanted) {
    const std::vector<VkPhysicalDevice> devices = instance_.physicalDevices();
    const std::vector<DeviceInfo> infos = describeDevices(devices);
    const std::vector<std::uint32_t> choice = chooseDevices(infos, wanted);
    for (const std::uint32_t index : choice) {
        const Suitability device = assess(devices[index]);
        if (!device.missing.empty()) continue;
        info_ = infos[index];
        physical_ = devices[index];
        queueFamily_ = device.queueFamily;
        timestampBits_ = device.timestampBits;
        return;
    }
    throw Error("the Vulkan device lacks " + assess(devices[choice.front()]).missing, infos[choice.front()].name,
                "choose another device, or install mesa-vulkan-drivers to render on the CPU");
}

void Context::openDevice() {
    VkPhysicalDeviceMaintenance3Properties maintenance{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES};
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &maintenance, {}};
    vkGetPhysicalDeviceProperties2(physical_, &properties);
    properties_ = properties.properties;
    maxAllocationBytes_ = maintenance.maxMemoryAllocationSize;

    VkDevice device = createDevice(physical_, queueFamily_);
    volkLoadDeviceTable(&api_, device);
    device_.reset(device);
    api_.vkGetDeviceQueue(device, queueFamily_, 0, &queue_);
    allocator_.emplace(physical_, device, api_, maxAllocationBytes_);
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
    const VkMemoryBarrier barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr, VK_ACCESS_MEMORY_WRITE_BIT,
                                  VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT};
    api_.vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                              VK_PIPELINE_STAGE_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &barrier, 0,
                              nullptr, 0, nullptr);
}

}  // namespace lumulus::gpu
