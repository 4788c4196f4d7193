#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace lumulus::gpu {

struct DeviceInfo {
    std::string name;
    std::string type;        ///< "discrete", "integrated", "virtual", "cpu" or "other"
    std::string driver;      ///< name and version of the driver
    std::string apiVersion;  ///< "1.3.230"
    std::uint32_t index = 0;
    std::uint64_t heapBytes = 0;  ///< sum of the memory heaps local to the device
};

/// Every Vulkan device of this machine, usable by Lumulus or not, by index.
/// Errors: Error where there is no Vulkan loader or no device.
std::vector<DeviceInfo> listDevices();

/// Indices of the devices that `wanted` allows, best first. `wanted` is an index, a part of a name (in any case), or
/// empty for all: discrete before integrated before virtual before cpu.
/// Errors: InputError naming the devices there are, where none fits.
std::vector<std::uint32_t> chooseDevices(const std::vector<DeviceInfo>& devices, const std::string& wanted);

}  // namespace lumulus::gpu
