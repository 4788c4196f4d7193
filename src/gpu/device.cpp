#include "gpu/device.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <span>
#include <string_view>
#include <utility>

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
constexpr const char* pushDescriptors = VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME;
constexpr const char* driverMend = "install a Vulkan driver, such as the package mesa-vulkan-drivers";

/// The values of a Vulkan enumeration: `call` takes a count and an array, as vkEnumerate* do after their own arguments.
template <class T, class Call>
std::vector<T> enumerate(const Call& call) {
    std::uint32_t count = 0;
    call(&count, nullptr);
    std::vector<T> values(count);
    call(&count, values.data());
    return values;
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
    if (result == VK_ERROR_LAYER_NOT_PRESENT)
        throw Error("the Vulkan validation layer is missing", validationLayer,
                    "install the package vulkan-validationlayers, or run without validation");
    check(result, "vkCreateInstance");
    volkLoadInstanceOnly(instance);
    return instance;
}

/// A chain of feature structs, for queries and for device creation.
struct Features {
    Features() = default;
    Features(const Features&) = delete;  // the structs point at each other

    /// The features that Lumulus needs, by name.
    std::array<std::pair<const char*, VkBool32*>, 5> needed() {
        return {{{"shaderInt64", &core.features.shaderInt64},
                 {"shaderStorageImageExtendedFormats", &core.features.shaderStorageImageExtendedFormats},
                 {"scalarBlockLayout", &v12.scalarBlockLayout},
                 {"shaderBufferInt64Atomics", &v12.shaderBufferInt64Atomics},
                 {"maintenance4", &v13.maintenance4}}};  // for local_size_x_id as glslang writes it
    }

    VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    VkPhysicalDeviceVulkan12Features v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, &v13};
    VkPhysicalDeviceFeatures2 core{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &v12, {}};
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

std::size_t rank(const DeviceInfo& device) {
    return std::string_view("discrete integrated virtual cpu").find(device.type);
}

/// An empty wish allows all; a number only the index, even where a name contains it.
bool allows(const std::string& wanted, const DeviceInfo& device) {
    if (wanted.find_first_not_of("0123456789") == std::string::npos)
        return wanted.empty() || wanted == std::to_string(device.index);
    const auto same = [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); };
    return !std::ranges::search(device.name, wanted, same).empty();
}

/// All else that Image does with its formats, Vulkan promises (with shaderStorageImageExtendedFormats).
bool filtersWideFloats(VkPhysicalDevice device) {
    const VkFormat formats[] = {VK_FORMAT_R32_SFLOAT, VK_FORMAT_R32G32_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT};
    return std::ranges::all_of(formats, [&](VkFormat format) {
        VkFormatProperties properties{};
        vkGetPhysicalDeviceFormatProperties(device, format, &properties);
        return (properties.optimalTilingFeatures & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT) != 0;
    });
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

void setObjectName(VkDevice device, VkObjectType type, std::uint64_t object, const std::string& name) {
    const VkDebugUtilsObjectNameInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT, nullptr, type, object,
                                             name.c_str()};
    check(vkSetDebugUtilsObjectNameEXT(device, &info), "vkSetDebugUtilsObjectNameEXT");
}

Instance::Instance(bool validation) {
    if (volkInitialize() != VK_SUCCESS)
        throw Error("the Vulkan loader is missing", "libvulkan.so.1",
                    "install it (package libvulkan1) and a driver, such as mesa-vulkan-drivers");
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
        [&](auto... out) { check(vkEnumeratePhysicalDevices(handle_.get(), out...), "vkEnumeratePhysicalDevices"); });
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
    std::ranges::stable_sort(fitting, {}, [&](std::uint32_t index) { return rank(devices[index]); });
    return fitting;
}

Suitability assess(VkPhysicalDevice device) {
    VkPhysicalDeviceProperties properties{};
    vkGetPhysicalDeviceProperties(device, &properties);
    if (properties.apiVersion < VK_API_VERSION_1_3) return {"Vulkan 1.3"};  // nor would it know the structs of Features
    Features offered;
    vkGetPhysicalDeviceFeatures2(device, &offered.core);
    for (const auto& [name, flag] : offered.needed())
        if (*flag == VK_FALSE) return {name};
    const auto extensions = enumerate<VkExtensionProperties>([&](auto... out) {
        check(vkEnumerateDeviceExtensionProperties(device, nullptr, out...), "vkEnumerateDeviceExtensionProperties");
    });
    const auto named = [](const auto& one) { return std::string_view(one.extensionName) == pushDescriptors; };
    if (std::ranges::none_of(extensions, named)) return {pushDescriptors};
    if (!filtersWideFloats(device)) return {"linear filtering of 32-bit floats"};
    const auto families = enumerate<VkQueueFamilyProperties>(
        [&](auto... out) { vkGetPhysicalDeviceQueueFamilyProperties(device, out...); });
    for (std::uint32_t i = 0; i < families.size(); ++i)
        if ((families[i].queueFlags & VK_QUEUE_COMPUTE_BIT) != 0 && families[i].timestampValidBits > 0)
            return {"", i, families[i].timestampValidBits};
    return {"a compute queue with timestamps"};
}

VkDevice createDevice(VkPhysicalDevice device, std::uint32_t queueFamily) {
    Features features;
    for (const auto& [name, flag] : features.needed()) *flag = VK_TRUE;
    const float priority = 1.0F;
    const VkDeviceQueueCreateInfo queue{
        VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, nullptr, 0, queueFamily, 1, &priority};
    const VkDeviceCreateInfo info{
        VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &features.core, 0, 1, &queue, 0, nullptr, 1, &pushDescriptors};
    VkDevice created = VK_NULL_HANDLE;
    check(vkCreateDevice(device, &info, nullptr, &created), "vkCreateDevice");
    return created;
}

}  // namespace lumulus::gpu
