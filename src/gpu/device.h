#pragma once

#include <volk.h>

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

namespace lumulus::gpu {

/// Throws Error naming `call` and the result as Vulkan spells it, unless the result is VK_SUCCESS.
void check(VkResult result, const char* call);

/// As check(), for a call that takes memory: the Error says which resource asked for how many bytes.
void checkMemory(VkResult result, const char* call, const std::string& resource, std::uint64_t bytes);

/// The values of a Vulkan enumeration: `call` takes a count and an array, as vkEnumerate* do after their own arguments.
template <class T, class Call>
std::vector<T> enumerate(const Call& call, const char* name) {
    std::uint32_t count = 0;
    check(call(&count, nullptr), name);
    std::vector<T> values(count);
    check(call(&count, values.data()), name);
    return values;
}

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

/// A texel format that Lumulus uses. A device must store to all of them and filter all but the integers.
struct TexelFormat {
    VkFormat format;
    const char* name;
    std::uint64_t bytes;
    bool integer;
};
inline constexpr TexelFormat texelFormats[] = {
    {VK_FORMAT_R8_UNORM, "R8_UNORM", 1, false}, {VK_FORMAT_R16_SFLOAT, "R16_SFLOAT", 2, false},
    {VK_FORMAT_R16_UINT, "R16_UINT", 2, true},  {VK_FORMAT_R32_SFLOAT, "R32_SFLOAT", 4, false},
    {VK_FORMAT_R32_UINT, "R32_UINT", 4, true},  {VK_FORMAT_R32G32B32A32_SFLOAT, "R32G32B32A32_SFLOAT", 16, false},
};

/// The chain of feature structs that Lumulus looks at, for queries and for device creation.
struct Features {
    VkPhysicalDeviceFeatures2 core{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, nullptr, {}};
    VkPhysicalDeviceVulkan12Features v12{};
    VkPhysicalDeviceVulkan13Features v13{};

    /// Links the structs by their present addresses; the result is valid until this value moves.
    VkPhysicalDeviceFeatures2* chain();
};

/// What a device offers of the things that Lumulus needs.
struct Capabilities {
    std::uint32_t apiVersion = 0;
    bool pushDescriptors = false;
    std::optional<std::uint32_t> queueFamily;  ///< computes, and has timestamps
    std::uint32_t timestampBits = 0;
    std::string missingFormat;  ///< the first use of a texel format that the device lacks
    Features features;
};

Capabilities queryCapabilities(VkPhysicalDevice device);

/// The name of the first thing that Lumulus needs and the device lacks; empty for a usable device.
std::string missingRequirement(const Capabilities& capabilities);

/// The features that Lumulus needs, switched on.
Features requiredFeatures();

}  // namespace lumulus::gpu
