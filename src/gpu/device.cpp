#include "gpu/device.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "base/error.h"
#include "gpu/instance.h"

namespace lumulus::gpu {
namespace {

std::string lowerCase(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return text;
}

std::size_t rank(const DeviceInfo& device) {
    const std::string order[] = {"discrete", "integrated", "virtual", "cpu"};
    return static_cast<std::size_t>(std::find(std::begin(order), std::end(order), device.type) - std::begin(order));
}

/// An empty wish allows all; a number only the index, even where a name contains it.
bool allows(const std::string& wanted, const DeviceInfo& device) {
    std::uint32_t index = 0;
    const char* end = wanted.data() + wanted.size();
    const auto [stop, error] = std::from_chars(wanted.data(), end, index);
    if (error == std::errc() && stop == end) {
        return device.index == index;
    }
    return lowerCase(device.name).find(lowerCase(wanted)) != std::string::npos;
}

std::string listed(const std::vector<DeviceInfo>& devices) {
    std::string text;
    for (const DeviceInfo& device : devices) {
        text += fmt::format("{}{} = {} [{}]", text.empty() ? "" : ", ", device.index, device.name, device.type);
    }
    return text;
}

}  // namespace

std::vector<DeviceInfo> listDevices() {
    const Instance instance(false);
    return describeDevices(instance.physicalDevices());
}

std::vector<std::uint32_t> chooseDevices(const std::vector<DeviceInfo>& devices, const std::string& wanted) {
    std::vector<DeviceInfo> fitting;
    std::copy_if(devices.begin(), devices.end(), std::back_inserter(fitting),
                 [&](const DeviceInfo& device) { return allows(wanted, device); });
    if (fitting.empty()) {
        throw InputError(fmt::format("no Vulkan device \"{}\"", wanted), "device", "choose from " + listed(devices));
    }
    std::stable_sort(fitting.begin(), fitting.end(),
                     [](const DeviceInfo& a, const DeviceInfo& b) { return rank(a) < rank(b); });
    std::vector<std::uint32_t> indices;
    std::transform(fitting.begin(), fitting.end(), std::back_inserter(indices),
                   [](const DeviceInfo& device) { return device.index; });
    return indices;
}

}  // namespace lumulus::gpu
