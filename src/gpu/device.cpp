#include "gpu/device.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <span>
#include <string_view>

#include "base/error.h"

namespace lumulus::gpu {
namespace {

std::string resultName(VkResult result) {
#define LUMULUS_RESULT(name) \
    if (result == name) return #name;
    LUMULUS_RESULT(VK_ERROR_OUT_OF_HOST_MEMORY)
    LUMULUS_RESULT(VK_ERROR_OUT_OF_DEVICE_MEMORY)
    LUMULUS_RESULT(VK_ERROR_INITIALIZATION_FAILED)
    LUMULUS_RESULT(VK_ERROR_DEVICE_LOST)
#undef LUMULUS_RESULT
    return fmt::format("VkResult {}", static_cast<int>(result));
}

constexpr const char* validationLayer = "VK_LAYER_KHRONOS_validation";
constexpr const char* driverMend = "install a Vulkan driver, such as the package mesa-vulkan-drivers";

/// Whether one of the layers or extensions has that name as its `member`.
template <class Properties, std::size_t n>
bool contains(const std::vector<Properties>& list, char (Properties::*member)[n], std::string_view name) {
    return std::any_of(list.begin(), list.end(), [&](const Properties& one) { return one.*member == name; });
}

VkInstance createInstance(bool validation, const VkDebugUtilsMessengerCreateInfoEXT& messenger) {
    const VkValidationFeatureEnableEXT synchronization = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    const VkValidationFeaturesEXT features{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT, &messenger, 1, &synchronization};
    VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO, nullptr, "lumulus"};
    application.apiVersion = VK_API_VERSION_1_3;
    const char* debugUtils = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;  // every loader for Vulkan 1.3 has it
    VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    info.pNext = validation ? &features : nullptr;
    info.pApplicationInfo = &application;
    info.enabledLayerCount = validation ? 1 : 0;
    info.ppEnabledLayerNames = &validationLayer;
    info.enabledExtensionCount = 1;
    info.ppEnabledExtensionNames = &debugUtils;
    VkInstance instance = VK_NULL_HANDLE;
    const VkResult result = vkCreateInstance(&info, nullptr, &instance);
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER) throw Error("no Vulkan driver", "Vulkan", driverMend);
    check(result, "vkCreateInstance");
    volkLoadInstanceOnly(instance);
    return instance;
}

struct Feature {
    const char* name;
    VkBool32& (*in)(Features&);
};

constexpr Feature neededFeatures[] = {
    {"shaderInt64", [](Features& f) -> VkBool32& { return f.core.features.shaderInt64; }},
    {"shaderStorageImageExtendedFormats",
     [](Features& f) -> VkBool32& { return f.core.features.shaderStorageImageExtendedFormats; }},
    {"scalarBlockLayout", [](Features& f) -> VkBool32& { return f.v12.scalarBlockLayout; }},
    {"shaderBufferInt64Atomics", [](Features& f) -> VkBool32& { return f.v12.shaderBufferInt64Atomics; }},
    {"synchronization2", [](Features& f) -> VkBool32& { return f.v13.synchronization2; }},
    // local_size_x_id as glslang writes it
    {"maintenance4", [](Features& f) -> VkBool32& { return f.v13.maintenance4; }},
};

/// By VkPhysicalDeviceType.
constexpr const char* typeNames[] = {"other", "integrated", "discrete", "virtual", "cpu"};

std::uint64_t localHeapBytes(VkPhysicalDevice device) {
    VkPhysicalDeviceMemoryProperties memory{};
    vkGetPhysicalDeviceMemoryProperties(device, &memory);
    std::uint64_t bytes = 0;
    for (const VkMemoryHeap& heap : std::span(memory.memoryHeaps, memory.memoryHeapCount))
        if ((heap.flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) != 0) bytes += heap.size;
    return bytes;
}

std::string lowerCase(std::string text) {
    for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return text;
}

std::size_t rank(const DeviceInfo& device) {
    return std::string_view("discrete integrated virtual cpu").find(device.type);
}

/// An empty wish allows all; a number only the index, even where a name contains it.
bool allows(const std::string& wanted, const DeviceInfo& device) {
    std::uint32_t index = 0;
    const char* end = wanted.data() + wanted.size();
    const auto [stop, error] = std::from_chars(wanted.data(), end, index);
    if (error == std::errc() && stop == end) return device.index == index;
    return lowerCase(device.name).find(lowerCase(wanted)) != std::string::npos;
}

std::string firstMissingFormat(VkPhysicalDevice device) {
    for (const TexelFormat& use : texelFormats) {
        VkFormatProperties properties{};
        vkGetPhysicalDeviceFormatProperties(device, use.format, &properties);
        const VkFormatFeatureFlags offered = properties.optimalTilingFeatures;
        if ((offered & VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT) == 0)
            return std::string("storage images of format ") + use.name;
        if (!use.integer && (offered & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT) == 0)
            return std::string("linear filtering of format ") + use.name;
    }
    return "";
}

}  // namespace

void check(VkResult result, const char* call) {
    if (result == VK_SUCCESS) return;
    throw Error(fmt::format("{} failed with {}", call, resultName(result)), "Vulkan",
                "check the graphics driver, or choose another device");
}

void checkMemory(VkResult result, const char* call, const std::string& resource, std::uint64_t bytes) {
    if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY)
        throw Error(fmt::format("{} for {} bytes failed with {}", call, bytes, resultName(result)), resource,
                    "use a smaller cloud, fewer photons or a device with more memory");
    check(result, call);
}

Instance::Instance(bool validation) {
    if (volkInitialize() != VK_SUCCESS)
        throw Error("the Vulkan loader is missing", "libvulkan.so.1",
                    "install it (package libvulkan1) and a driver, such as mesa-vulkan-drivers");
    const auto layers =
        enumerate<VkLayerProperties>(vkEnumerateInstanceLayerProperties, "vkEnumerateInstanceLayerProperties");
    if (validation && !contains(layers, &VkLayerProperties::layerName, validationLayer))
        throw Error("the Vulkan validation layer is missing", validationLayer,
                    "install the package vulkan-validationlayers, or run without validation");
    VkDebugUtilsMessengerCreateInfoEXT messenger{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
    messenger.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    // not GENERAL, where the loader talks about drivers without a device, nor PERFORMANCE, which dislikes that images
    // stay in layout GENERAL
    messenger.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    messenger.pUserData = this;
    messenger.pfnUserCallback = [](auto /*severity*/, auto /*type*/, const auto* data, void* user) {
        auto& instance = *static_cast<Instance*>(user);
        const std::lock_guard lock(instance.mutex_);
        instance.messages_.emplace_back(data->pMessage);
        return VkBool32{VK_FALSE};
    };
    handle_.reset(createInstance(validation, messenger));
    if (validation)
        check(vkCreateDebugUtilsMessengerEXT(handle_.get(), &messenger, nullptr, &messenger_),
              "vkCreateDebugUtilsMessengerEXT");
}

Instance::~Instance() {
    if (messenger_ != VK_NULL_HANDLE) vkDestroyDebugUtilsMessengerEXT(handle_.get(), messenger_, nullptr);
}

std::vector<std::string> Instance::messages() const {
    const std::lock_guard lock(mutex_);
    return messages_;
}

std::vector<VkPhysicalDevice> Instance::physicalDevices() const {
    auto devices = enumerate<VkPhysicalDevice>(
        [&](auto... out) { return vkEnumeratePhysicalDevices(handle_.get(), out...); }, "vkEnumeratePhysicalDevices");
    if (devices.empty()) throw Error("no Vulkan device", "Vulkan", driverMend);
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
                         .type = typeNames[core.deviceType],
                         .driver = fmt::format("{} {}", driver.driverName, driver.driverInfo),
                         .apiVersion = fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(version),
                                                   VK_API_VERSION_MINOR(version), VK_API_VERSION_PATCH(version)),
                         .index = static_cast<std::uint32_t>(infos.size()),
                         .heapBytes = localHeapBytes(device)});
    }
    return infos;
}

std::vector<DeviceInfo> listDevices() {
    return describeDevices(Instance(false).physicalDevices());
}

std::vector<std::uint32_t> chooseDevices(const std::vector<DeviceInfo>& devices, const std::string& wanted) {
    std::vector<std::uint32_t> fitting;
    std::string listed;
    for (const DeviceInfo& device : devices) {
        if (allows(wanted, device)) fitting.push_back(device.index);
        listed += fmt::format("{}{} = {} [{}]", listed.empty() ? "" : ", ", device.index, device.name, device.type);
    }
    if (fitting.empty())
        throw InputError(fmt::format("no Vulkan device \"{}\"", wanted), "device", "choose from " + listed);
    std::stable_sort(fitting.begin(), fitting.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return rank(devices[a]) < rank(devices[b]); });
    return fitting;
}

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
    if (properties.apiVersion >= VK_API_VERSION_1_3)  // an older device does not know the structs of the chain
        vkGetPhysicalDeviceFeatures2(device, capabilities.features.chain());
    const auto extensions = enumerate<VkExtensionProperties>(
        [&](auto... out) { return vkEnumerateDeviceExtensionProperties(device, nullptr, out...); },
        "vkEnumerateDeviceExtensionProperties");
    capabilities.pushDescriptors =
        contains(extensions, &VkExtensionProperties::extensionName, VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME);
    capabilities.missingFormat = firstMissingFormat(device);
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
    for (std::uint32_t i = 0; i < count && !capabilities.queueFamily; ++i) {
        if ((families[i].queueFlags & VK_QUEUE_COMPUTE_BIT) == 0 || families[i].timestampValidBits == 0) continue;
        capabilities.queueFamily = i;
        capabilities.timestampBits = families[i].timestampValidBits;
    }
    return capabilities;
}

std::string missingRequirement(const Capabilities& capabilities) {
    if (capabilities.apiVersion < VK_API_VERSION_1_3) return "Vulkan 1.3";
    Features offered = capabilities.features;
    for (const Feature& feature : neededFeatures)
        if (feature.in(offered) == VK_FALSE) return feature.name;
    if (!capabilities.pushDescriptors) return VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME;
    if (!capabilities.queueFamily) return "a compute queue with timestamps";
    return capabilities.missingFormat;
}

Features requiredFeatures() {
    Features features;
    for (const Feature& feature : neededFeatures) feature.in(features) = VK_TRUE;
    return features;
}

}  // namespace lumulus::gpu
