#include "gpu/instance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <mutex>

#include "base/error.h"
#include "gpu/result.h"

namespace lumulus::gpu {
namespace {

constexpr const char* validationLayer = "VK_LAYER_KHRONOS_validation";
constexpr const char* driverMend = "install a Vulkan driver, such as the package mesa-vulkan-drivers";

bool hasLayer(const char* wanted) {
    const auto layers =
        enumerate<VkLayerProperties>(vkEnumerateInstanceLayerProperties, "vkEnumerateInstanceLayerProperties");
    return std::any_of(layers.begin(), layers.end(),
                       [&](const VkLayerProperties& layer) { return std::strcmp(layer.layerName, wanted) == 0; });
}

bool hasExtension(const char* wanted) {
    const auto extensions = enumerate<VkExtensionProperties>(
        [](auto... out) { return vkEnumerateInstanceExtensionProperties(nullptr, out...); },
        "vkEnumerateInstanceExtensionProperties");
    return std::any_of(extensions.begin(), extensions.end(), [&](const VkExtensionProperties& extension) {
        return std::strcmp(extension.extensionName, wanted) == 0;
    });
}

const char* typeName(VkPhysicalDeviceType type) {
    switch (type) {
        case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
            return "discrete";
        case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
            return "integrated";
        case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
            return "virtual";
        case VK_PHYSICAL_DEVICE_TYPE_CPU:
            return "cpu";
        default:
            return "other";
    }
}

std::uint64_t localHeapBytes(VkPhysicalDevice device) {
    VkPhysicalDeviceMemoryProperties memory{};
    vkGetPhysicalDeviceMemoryProperties(device, &memory);
    std::uint64_t bytes = 0;
    for (std::uint32_t i = 0; i < memory.memoryHeapCount; ++i) {
        const VkMemoryHeap& heap = memory.memoryHeaps[i];
        bytes += (heap.flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) != 0 ? heap.size : 0;
    }
    return bytes;
}

}  // namespace

/// Layers may call from any thread.
struct Instance::MessageLog {
    std::mutex mutex;
    std::vector<std::string> messages;

    static VKAPI_ATTR VkBool32 VKAPI_CALL receive(VkDebugUtilsMessageSeverityFlagBitsEXT /*severity*/,
                                                  VkDebugUtilsMessageTypeFlagsEXT /*types*/,
                                                  const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
        auto& log = *static_cast<MessageLog*>(user);
        const std::lock_guard lock(log.mutex);
        log.messages.emplace_back(data->pMessage);
        return VK_FALSE;
    }
};

Instance::Instance(bool validation) : log_(std::make_unique<MessageLog>()) {
    if (volkInitialize() != VK_SUCCESS) {
        throw Error("the Vulkan loader is missing", "libvulkan.so.1",
                    "install it (package libvulkan1) and a driver, such as mesa-vulkan-drivers");
    }
    if (validation && !hasLayer(validationLayer)) {
        throw Error("the Vulkan validation layer is missing", validationLayer,
                    "install the package vulkan-validationlayers, or run without validation");
    }
    debugUtils_ = hasExtension(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    create(validation);
}

void Instance::create(bool validation) {
    VkDebugUtilsMessengerCreateInfoEXT messenger{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
    messenger.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    // not GENERAL, where the loader talks about drivers without a device, nor PERFORMANCE, which dislikes that images
    // stay in layout GENERAL
    messenger.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    messenger.pfnUserCallback = MessageLog::receive;
    messenger.pUserData = log_.get();
    const VkValidationFeatureEnableEXT synchronization = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    VkValidationFeaturesEXT features{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT};
    features.pNext = &messenger;
    features.enabledValidationFeatureCount = 1;
    features.pEnabledValidationFeatures = &synchronization;

    VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
    application.pApplicationName = "lumulus";
    application.apiVersion = VK_API_VERSION_1_3;
    const char* extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    info.pNext = validation ? &features : nullptr;
    info.pApplicationInfo = &application;
    info.enabledLayerCount = validation ? 1 : 0;
    info.ppEnabledLayerNames = &validationLayer;
    info.enabledExtensionCount = debugUtils_ ? 1 : 0;
    info.ppEnabledExtensionNames = &extension;
    const VkResult result = vkCreateInstance(&info, nullptr, &handle_);
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER) {
        throw Error("no Vulkan driver", "Vulkan", driverMend);
    }
    check(result, "vkCreateInstance");
    volkLoadInstanceOnly(handle_);
    if (validation && debugUtils_) {
        const VkResult messengerResult = vkCreateDebugUtilsMessengerEXT(handle_, &messenger, nullptr, &messenger_);
        if (messengerResult != VK_SUCCESS) {
            vkDestroyInstance(handle_, nullptr);
            check(messengerResult, "vkCreateDebugUtilsMessengerEXT");
        }
    }
}

Instance::~Instance() {
    if (messenger_ != VK_NULL_HANDLE) {
        vkDestroyDebugUtilsMessengerEXT(handle_, messenger_, nullptr);
    }
    vkDestroyInstance(handle_, nullptr);
}

std::vector<std::string> Instance::messages() const {
    const std::lock_guard lock(log_->mutex);
    return log_->messages;
}

std::vector<VkPhysicalDevice> Instance::physicalDevices() const {
    auto devices = enumerate<VkPhysicalDevice>([&](auto... out) { return vkEnumeratePhysicalDevices(handle_, out...); },
                                               "vkEnumeratePhysicalDevices");
    if (devices.empty()) {
        throw Error("no Vulkan device", "Vulkan", driverMend);
    }
    return devices;
}

std::vector<DeviceInfo> describeDevices(const std::vector<VkPhysicalDevice>& devices) {
    std::vector<DeviceInfo> infos;
    for (VkPhysicalDevice device : devices) {
        VkPhysicalDeviceDriverProperties driver{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
        VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &driver, {}};
        vkGetPhysicalDeviceProperties2(device, &properties);
        const VkPhysicalDeviceProperties& core = properties.properties;
        const std::uint32_t version = core.apiVersion;
        infos.push_back({.name = core.deviceName,
                         .type = typeName(core.deviceType),
                         .driver = fmt::format("{} {}", driver.driverName, driver.driverInfo),
                         .apiVersion = fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(version),
                                                   VK_API_VERSION_MINOR(version), VK_API_VERSION_PATCH(version)),
                         .index = static_cast<std::uint32_t>(infos.size()),
                         .heapBytes = localHeapBytes(device)});
    }
    return infos;
}

}  // namespace lumulus::gpu
