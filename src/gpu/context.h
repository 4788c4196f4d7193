#pragma once

#include <volk.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "gpu/device.h"
#include "gpu/instance.h"
#include "gpu/owned.h"
#include "gpu/result.h"
#include "gpu/sampler.h"

namespace lumulus::gpu {

struct ContextOptions {
    std::string device;       ///< index or part of a name; empty: the best device
    bool validation = false;  ///< Khronos validation layer with synchronisation validation
};

/// One Vulkan device with one queue, and what all passes share. Everything made from a context points at it, so it is
/// neither copied nor moved and must outlive them. Used by one thread at a time.
/// Errors: InputError for an unknown device; Error for no loader, no device, a missing feature or layer.
class Context {
  public:
    explicit Context(const ContextOptions& options);
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;
    ~Context();

    const DeviceInfo& device() const { return info_; }
    bool isCpu() const { return info_.type == "cpu"; }
    /// Warnings and errors of the validation layer so far.
    std::vector<std::string> validationMessages() const { return instance_.messages(); }
    /// Bytes of device memory that buffers and images hold now.
    std::uint64_t allocatedBytes() const { return allocatedBytes_; }
    const VkPhysicalDeviceLimits& limits() const { return properties_.limits; }

    VkDevice handle() const { return device_.handle; }
    VkPhysicalDevice physicalDevice() const { return physical_; }
    const VolkDeviceTable& api() const { return device_.api; }
    std::uint32_t queueFamily() const { return queueFamily_; }
    VkPipelineCache pipelineCache() const { return pipelineCache_.get(); }
    std::uint32_t timestampBits() const { return timestampBits_; }
    std::uint64_t maxAllocationBytes() const { return maxAllocationBytes_; }
    /// Border colours differ for integer texels. `kind` must not be Sampler::none.
    VkSampler sampler(Sampler kind, bool integerTexels) const;

    /// Makes an object of the device: `make` and `destroy` are its functions in api(), `name` is shown in messages of
    /// the validation layer and in debuggers, `bytes` is what it will take of memory, for the error.
    template <class T, class Info>
    Owned<T> create(VkResult(VKAPI_PTR* make)(VkDevice, const Info*, const VkAllocationCallbacks*, T*),
                    typename Owned<T>::Destroy destroy, const Info& info, VkObjectType type, const std::string& name,
                    std::uint64_t bytes = 0) const {
        T object = VK_NULL_HANDLE;
        checkMemory(make(handle(), &info, nullptr, &object), "making it", name, bytes);
        Owned<T> owned(handle(), object, destroy);
        setName(type, reinterpret_cast<std::uint64_t>(object), name);
        return owned;
    }
    void setName(VkObjectType type, std::uint64_t object, const std::string& name) const;
    bool hasDebugUtils() const { return instance_.hasDebugUtils(); }

    /// Records, submits and waits. Ordered by full barriers after all earlier work and before all later work.
    void immediately(const std::function<void(VkCommandBuffer)>& record);
    /// Hands a command buffer to the queue; the fence is signalled when it is done.
    void submit(VkCommandBuffer commands, VkFence fence) const;
    /// Waits for the fence and resets it.
    void waitFor(VkFence fence) const;
    /// All writes before are visible to everything after, on the device and the host.
    void recordFullBarrier(VkCommandBuffer commands) const;

    /// The bookkeeping behind allocatedBytes().
    void addAllocated(std::uint64_t bytes) { allocatedBytes_ += bytes; }
    void subtractAllocated(std::uint64_t bytes) { allocatedBytes_ -= bytes; }
    /// A number that no other resource of this context has.
    std::uint64_t nextResourceId() { return ++lastResourceId_; }

  private:
    /// The logical device and its functions; destroyed after everything made from it.
    struct LogicalDevice {
        VkDevice handle = VK_NULL_HANDLE;
        VolkDeviceTable api{};

        LogicalDevice() = default;
        LogicalDevice(const LogicalDevice&) = delete;
        LogicalDevice& operator=(const LogicalDevice&) = delete;
        ~LogicalDevice();
    };

    void selectPhysicalDevice(const std::string& wanted);
    void createDevice();
    void createSharedObjects();

    std::atomic<std::uint64_t> allocatedBytes_ = 0;
    std::atomic<std::uint64_t> lastResourceId_ = 0;
    Instance instance_;
    DeviceInfo info_;
    VkPhysicalDevice physical_ = VK_NULL_HANDLE;
    VkPhysicalDeviceProperties properties_{};
    std::uint64_t maxAllocationBytes_ = 0;
    std::uint32_t queueFamily_ = 0;
    std::uint32_t timestampBits_ = 0;
    LogicalDevice device_;
    VkQueue queue_ = VK_NULL_HANDLE;
    Owned<VkPipelineCache> pipelineCache_;
    Owned<VkCommandPool> immediatePool_;
    Owned<VkFence> immediateFence_;
    std::array<Owned<VkSampler>, samplerCount> samplers_;
    Owned<VkSampler> integerSampler_;
};

}  // namespace lumulus::gpu
