#pragma once

#include <volk.h>

#include <cstdint>
#include <optional>
#include <string>

namespace lumulus::gpu {

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
