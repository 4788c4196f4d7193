#pragma once

#include <volk.h>

#include <cstdint>
#include <string>
#include <vector>

namespace lumulus::gpu {

/// The name of a result as the Vulkan specification spells it.
std::string resultName(VkResult result);

/// Throws Error naming `call` and the result, unless the result is VK_SUCCESS.
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

}  // namespace lumulus::gpu
