#pragma once

#include <volk.h>

#include <memory>
#include <mutex>
#include <string>
#include <type_traits>
#include <vector>

namespace lumulus::gpu {

/// Throws Error naming `call` and the result as Vulkan spells it, unless the result is VK_SUCCESS.
void check(VkResult result, const char* call);

/// As check(), for a call that takes memory: the Error says which resource asked for how many bytes.
void checkMemory(VkResult result, const char* call, const std::string& resource, std::uint64_t bytes);

/// Names an object of the device in messages of the validation layer and in debuggers.
void setObjectName(VkDevice device, VkObjectType type, std::uint64_t object, const std::string& name);

template <class T>
struct Destroy {
    using pointer = T;

    VkDevice device = VK_NULL_HANDLE;
    void(VKAPI_PTR* call)(VkDevice, T, const VkAllocationCallbacks*) = nullptr;

    void operator()(T object) const { call(device, object, nullptr); }
};

/// An object of a Vulkan device, destroyed with its owner.
template <class T>
using Owned = std::unique_ptr<std::remove_pointer_t<T>, Destroy<T>>;

struct DeviceInfo {
    std::string name;
    std::string type;        ///< "discrete", "integrated", "virtual", "cpu" or "other"
    std::string driver;      ///< name and version of the driver
    std::string apiVersion;  ///< "1.3.230"
    std::uint32_t index = 0;
    std::uint64_t heapBytes = 0;  ///< sum of the memory heaps local to the device
};

/// The Vulkan loader's instance, with the validation layer and the list of its messages where asked for.
/// Make instances on one thread at a time: the loader's entry points are those of volk, which are global.
/// Errors: Error where the loader, every driver, or the layer that was asked for is missing.
class Instance {
  public:
    explicit Instance(bool validation);
    Instance(const Instance&) = delete;
    ~Instance();

    /// Warnings and errors of the validation layer.
    std::vector<std::string> messages() const;
    /// Errors: Error where there is none.
    std::vector<VkPhysicalDevice> physicalDevices() const;

  private:
    struct Destroy {
        void operator()(VkInstance instance) const { vkDestroyInstance(instance, nullptr); }
    };

    mutable std::mutex mutex_;  ///< layers may call from any thread
    std::vector<std::string> messages_;
    std::unique_ptr<VkInstance_T, Destroy> handle_;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
};

/// What a person wants to know of each device; `index` counts from 0.
std::vector<DeviceInfo> describeDevices(const std::vector<VkPhysicalDevice>& devices);

/// Every Vulkan device of this machine, usable by Lumulus or not, by index.
/// Errors: Error where there is no Vulkan loader or no device.
std::vector<DeviceInfo> listDevices();

/// Indices of the devices that `wanted` allows, best first. `wanted` is an index, a part of a name (in any case), or
/// empty for all: discrete before integrated before virtual before cpu.
/// Errors: InputError naming the devices there are, where none fits.
std::vector<std::uint32_t> chooseDevices(const std::vector<DeviceInfo>& devices, const std::string& wanted);

/// Whether Lumulus can use a device, and what of it.
struct Suitability {
    std::string missing;            ///< the first thing that Lumulus needs and the device lacks; empty: usable
    std::uint32_t queueFamily = 0;  ///< computes, and has timestamps
    std::uint32_t timestampBits = 0;
};

/// Errors: Error where Vulkan fails.
Suitability assess(VkPhysicalDevice device);

/// A device with the features that Lumulus needs and one queue, of that family. It must be suitable.
/// Errors: Error where Vulkan fails. The caller destroys it.
VkDevice createDevice(VkPhysicalDevice device, std::uint32_t queueFamily);

}  // namespace lumulus::gpu
