#include "gpu/requirements.h"

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "gpu/result.h"

namespace lumulus::gpu {
namespace {

template <class Struct>
using FeatureName = std::pair<const char*, VkBool32 Struct::*>;

constexpr FeatureName<VkPhysicalDeviceFeatures> coreFeatures[] = {
    {"shaderInt64", &VkPhysicalDeviceFeatures::shaderInt64},
    {"shaderStorageImageExtendedFormats", &VkPhysicalDeviceFeatures::shaderStorageImageExtendedFormats},
};
constexpr FeatureName<VkPhysicalDeviceVulkan12Features> v12Features[] = {
    {"scalarBlockLayout", &VkPhysicalDeviceVulkan12Features::scalarBlockLayout},
    {"shaderBufferInt64Atomics", &VkPhysicalDeviceVulkan12Features::shaderBufferInt64Atomics},
};
constexpr FeatureName<VkPhysicalDeviceVulkan13Features> v13Features[] = {
    {"synchronization2", &VkPhysicalDeviceVulkan13Features::synchronization2},
    {"maintenance4", &VkPhysicalDeviceVulkan13Features::maintenance4},  // local_size_x_id as glslang writes it
};

struct FormatUse {
    const char* name;
    VkFormat format;
    bool filtered;
};

constexpr FormatUse formatUses[] = {
    {"R32_SFLOAT", VK_FORMAT_R32_SFLOAT, true}, {"R16_SFLOAT", VK_FORMAT_R16_SFLOAT, true},
    {"R8_UNORM", VK_FORMAT_R8_UNORM, true},     {"R16_UINT", VK_FORMAT_R16_UINT, false},
    {"R32_UINT", VK_FORMAT_R32_UINT, false},
};

template <class Struct, std::size_t n>
const char* firstMissing(const Struct& offered, const FeatureName<Struct> (&needed)[n]) {
    const auto* found =
        std::find_if(std::begin(needed), std::end(needed), [&](auto& feature) { return !(offered.*feature.second); });
    return found == std::end(needed) ? "" : found->first;
}

std::string firstMissingFormat(VkPhysicalDevice device) {
    for (const FormatUse& use : formatUses) {
        VkFormatProperties properties{};
        vkGetPhysicalDeviceFormatProperties(device, use.format, &properties);
        if ((properties.optimalTilingFeatures & VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT) == 0) {
            return std::string("storage images of format ") + use.name;
        }
        if (use.filtered &&
            (properties.optimalTilingFeatures & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT) == 0) {
            return std::string("linear filtering of format ") + use.name;
        }
    }
    return "";
}

bool hasPushDescriptors(VkPhysicalDevice device) {
    const auto extensions = enumerate<VkExtensionProperties>(
        [&](auto... out) { return vkEnumerateDeviceExtensionProperties(device, nullptr, out...); },
        "vkEnumerateDeviceExtensionProperties");
    return std::any_of(extensions.begin(), extensions.end(), [](const VkExtensionProperties& extension) {
        return std::strcmp(extension.extensionName, VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME) == 0;
    });
}

void findQueue(VkPhysicalDevice device, Capabilities& capabilities) {
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
    for (std::uint32_t i = 0; i < count && !capabilities.queueFamily; ++i) {
        if ((families[i].queueFlags & VK_QUEUE_COMPUTE_BIT) != 0 && families[i].timestampValidBits > 0) {
            capabilities.queueFamily = i;
            capabilities.timestampBits = families[i].timestampValidBits;
        }
    }
}

}  // namespace

VkPhysicalDeviceFeatures2* Features::chain() {
    v13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
    v12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    v12.pNext = &v13;
    core.pNext = &v12;
    return &core;
}

Capabilities queryCapabilities(VkPhysicalDevice device) {
    VkPhysicalDeviceProperties properties{};
    vkGetPhysicalDeviceProperties(device, &properties);
    Capabilities capabilities;
    capabilities.apiVersion = properties.apiVersion;
    if (properties.apiVersion >= VK_API_VERSION_1_3) {  // an older device does not know the structs of the chain
        vkGetPhysicalDeviceFeatures2(device, capabilities.features.chain());
    }
    capabilities.pushDescriptors = hasPushDescriptors(device);
    capabilities.missingFormat = firstMissingFormat(device);
    findQueue(device, capabilities);
    return capabilities;
}

std::string missingRequirement(const Capabilities& capabilities) {
    if (capabilities.apiVersion < VK_API_VERSION_1_3) {
        return "Vulkan 1.3";
    }
    for (const char* missing :
         {firstMissing(capabilities.features.core.features, coreFeatures),
          firstMissing(capabilities.features.v12, v12Features), firstMissing(capabilities.features.v13, v13Features)}) {
        if (*missing != '\0') {
            return missing;
        }
    }
    if (!capabilities.pushDescriptors) {
        return VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME;
    }
    if (!capabilities.queueFamily) {
        return "a compute queue with timestamps";
    }
    return capabilities.missingFormat;
}

Features requiredFeatures() {
    Features features;
    for (const auto& [name, member] : coreFeatures) {
        features.core.features.*member = VK_TRUE;
    }
    for (const auto& [name, member] : v12Features) {
        features.v12.*member = VK_TRUE;
    }
    for (const auto& [name, member] : v13Features) {
        features.v13.*member = VK_TRUE;
    }
    return features;
}

}  // namespace lumulus::gpu
