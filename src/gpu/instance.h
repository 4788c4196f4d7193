#pragma once

#include <volk.h>

#include <memory>
#include <string>
#include <vector>

#include "gpu/device.h"

namespace lumulus::gpu {

/// The Vulkan loader's instance, with the validation layer and the list of its messages where asked for.
/// Make instances on one thread at a time: the loader's entry points are those of volk, which are global.
/// Errors: Error where the loader, every driver, or the layer that was asked for is missing.
class Instance {
  public:
    explicit Instance(bool validation);
    Instance(const Instance&) = delete;
    Instance& operator=(const Instance&) = delete;
    ~Instance();

    bool hasDebugUtils() const { return debugUtils_; }
    /// Messages of the validation layer, warnings and errors; empty without validation.
    std::vector<std::string> messages() const;
    /// Errors: Error where there is none.
    std::vector<VkPhysicalDevice> physicalDevices() const;

  private:
    struct MessageLog;

    void create(bool validation);

    std::unique_ptr<MessageLog> log_;  ///< a fixed address for the layer's callback
    bool debugUtils_ = false;
    VkInstance handle_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
};

/// What a person wants to know of each device; `index` counts from 0.
std::vector<DeviceInfo> describeDevices(const std::vector<VkPhysicalDevice>& devices);

}  // namespace lumulus::gpu
