#include "gpu/result.h"

#include <fmt/format.h>

#include "base/error.h"

namespace lumulus::gpu {

std::string resultName(VkResult result) {
    switch (result) {
#define LUMULUS_RESULT(name) \
    case name:               \
        return #name;
        LUMULUS_RESULT(VK_SUCCESS)
        LUMULUS_RESULT(VK_NOT_READY)
        LUMULUS_RESULT(VK_TIMEOUT)
        LUMULUS_RESULT(VK_INCOMPLETE)
        LUMULUS_RESULT(VK_ERROR_OUT_OF_HOST_MEMORY)
        LUMULUS_RESULT(VK_ERROR_OUT_OF_DEVICE_MEMORY)
        LUMULUS_RESULT(VK_ERROR_INITIALIZATION_FAILED)
        LUMULUS_RESULT(VK_ERROR_DEVICE_LOST)
        LUMULUS_RESULT(VK_ERROR_MEMORY_MAP_FAILED)
        LUMULUS_RESULT(VK_ERROR_LAYER_NOT_PRESENT)
        LUMULUS_RESULT(VK_ERROR_EXTENSION_NOT_PRESENT)
        LUMULUS_RESULT(VK_ERROR_FEATURE_NOT_PRESENT)
        LUMULUS_RESULT(VK_ERROR_INCOMPATIBLE_DRIVER)
        LUMULUS_RESULT(VK_ERROR_TOO_MANY_OBJECTS)
        LUMULUS_RESULT(VK_ERROR_FORMAT_NOT_SUPPORTED)
        LUMULUS_RESULT(VK_ERROR_FRAGMENTED_POOL)
        LUMULUS_RESULT(VK_ERROR_UNKNOWN)
#undef LUMULUS_RESULT
        default:
            return fmt::format("VkResult {}", static_cast<int>(result));
    }
}

void check(VkResult result, const char* call) {
    if (result != VK_SUCCESS) {
        throw Error(fmt::format("{} failed with {}", call, resultName(result)), "Vulkan",
                    result == VK_ERROR_DEVICE_LOST ? "check the graphics driver, or choose another device"
                                                   : "check the graphics driver");
    }
}

void checkMemory(VkResult result, const char* call, const std::string& resource, std::uint64_t bytes) {
    if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY) {
        throw Error(fmt::format("{} for {} bytes failed with {}", call, bytes, resultName(result)), resource,
                    "use a smaller cloud, fewer photons or a device with more memory");
    }
    check(result, call);
}

}  // namespace lumulus::gpu
