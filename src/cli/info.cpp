#include "cli/info.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>

#include "base/error.h"
#include "base/text.h"
#include "cli/output.h"
#include "gpu/device.h"
#include "scene/document.h"
#include "vdb/describe.h"

namespace lumulus::cli {
namespace {

using Json = nlohmann::ordered_json;

// names of grids and devices may hold bytes that are no UTF-8
std::string dumped(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string devicesJson(const std::vector<gpu::DeviceInfo>& devices) {
    Json list = Json::array();
    for (const gpu::DeviceInfo& device : devices) {
        list.push_back({{"index", device.index},
                        {"name", device.name},
                        {"type", device.type},
                        {"driver", device.driver},
                        {"api_version", device.apiVersion},
                        {"heap_bytes", device.heapBytes}});
    }
    return dumped({{"devices", list}});
}

/// Text of a file or a driver, made safe for a terminal.
std::string shown(const std::string& name) {
    return shortened(oneLine(name), 300);
}

std::string devicesText(const std::vector<gpu::DeviceInfo>& devices) {
    std::string text;
    for (const gpu::DeviceInfo& device : devices) {
        text += fmt::format("{}  {} ({}), driver {}, Vulkan {}, {:.2f} GiB\n", device.index, shown(device.name),
                            device.type, shown(device.driver), device.apiVersion,
                            static_cast<double>(device.heapBytes) / 1073741824.0);
    }
    return text;
}

Json vectorJson(const auto& v) {
    return Json::array({v.x, v.y, v.z});
}

std::string gridsJson(const std::filesystem::path& file, const std::vector<vdb::GridInfo>& grids) {
    Json list = Json::array();
    for (const vdb::GridInfo& grid : grids) {
        Json entry{{"name", grid.name},
                   {"type", grid.type},
                   {"class", grid.gridClass},
                   {"affine", grid.affine},
                   {"active_voxels", grid.activeVoxels},
                   {"active_minimum", vectorJson(grid.activeMinimum)},
                   {"active_maximum", vectorJson(grid.activeMaximum)},
                   {"voxel_size", vectorJson(grid.voxelSize)}};
        if (grid.values) {
            entry["values"] = {{"minimum", grid.values->minimum},
                               {"maximum", grid.values->maximum},
                               {"mean", grid.values->mean},
                               {"background", grid.values->background}};
        }
        list.push_back(entry);
    }
    return dumped({{"file", file.string()}, {"grids", list}});
}

std::string gridsText(const std::vector<vdb::GridInfo>& grids) {
    if (grids.empty()) return "no grids\n";
    std::string text;
    for (const vdb::GridInfo& grid : grids) {
        const glm::ivec3 extent = grid.activeMaximum - grid.activeMinimum + 1;
        text += fmt::format("{}: {}, {}{}\n", shown(grid.name), shown(grid.type), grid.gridClass,
                            grid.affine ? "" : ", transform not affine");
        text +=
            fmt::format("  voxels    {} active, in {} x {} x {}\n", grid.activeVoxels, extent.x, extent.y, extent.z);
        text += fmt::format("  from      {} {} {} to {} {} {}\n", grid.activeMinimum.x, grid.activeMinimum.y,
                            grid.activeMinimum.z, grid.activeMaximum.x, grid.activeMaximum.y, grid.activeMaximum.z);
        text += fmt::format("  voxel     {:.6g} x {:.6g} x {:.6g} m\n", grid.voxelSize.x, grid.voxelSize.y,
                            grid.voxelSize.z);
        if (grid.values) {
            text += fmt::format("  values    {:.6g} to {:.6g}, mean {:.6g}, background {:.6g}\n", grid.values->minimum,
                                grid.values->maximum, grid.values->mean, grid.values->background);
        }
    }
    return text;
}

}  // namespace

void runInfo(const InfoOptions& options) {
    const int wanted = (options.file.empty() ? 0 : 1) + (options.devices ? 1 : 0) + (options.sceneFormat ? 1 : 0);
    if (wanted != 1) {
        throw InputError("info needs exactly one subject", "command line",
                         "give an OpenVDB file, --devices or --scene-format");
    }
    if (options.sceneFormat) {
        printOut(scene::sceneFormatMarkdown());
    } else if (options.devices) {
        const auto devices = gpu::listDevices();
        printOut(options.json ? devicesJson(devices) : devicesText(devices));
    } else {
        const auto grids = vdb::describe(options.file);
        printOut(options.json ? gridsJson(options.file, grids) : gridsText(grids));
    }
}

}  // namespace lumulus::cli
