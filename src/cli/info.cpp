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

/// Rows of the matrix that acts on columns (x, y, z, 1), as `cloud.transform` in a scene.
Json matrixJson(const vdb::Affine& affine) {
    Json rows = Json::array();
    for (int row = 0; row < 3; ++row)
        rows.push_back({affine.linear[0][row], affine.linear[1][row], affine.linear[2][row], affine.translation[row]});
    rows.push_back({0.0, 0.0, 0.0, 1.0});
    return rows;
}

Json gridJson(const vdb::GridInfo& grid) {
    Json entry{{"name", grid.name},
               {"type", grid.type},
               {"class", grid.gridClass},
               {"taken", grid.taken},
               {"affine", grid.affine},
               {"active_voxels", grid.activeVoxels},
               {"active_minimum", vectorJson(grid.activeMinimum)},
               {"active_maximum", vectorJson(grid.activeMaximum)},
               {"voxel_size", vectorJson(grid.voxelSize)}};
    if (grid.place) {
        entry["transform"] = matrixJson(grid.place->toWorld);
        entry["world_minimum"] = vectorJson(grid.place->minimum);
        entry["world_maximum"] = vectorJson(grid.place->maximum);
        entry["mirrored"] = grid.place->mirrored;
        entry["rotated"] = grid.place->rotated;
    }
    if (grid.values) {
        entry["values"] = {{"minimum", grid.values->minimum},
                           {"maximum", grid.values->maximum},
                           {"mean", grid.values->mean},
                           {"background", grid.values->background},
                           {"not_finite", grid.values->notFinite}};
    }
    if (grid.bricks) entry["bricks"] = {{"with_density", grid.bricks->first}, {"of_the_box", grid.bricks->second}};
    if (grid.thickness) {
        entry["optical_thickness"] = {{"extinction", 1.0},
                                      {"largest", vectorJson(grid.thickness->largest)},
                                      {"mean", vectorJson(grid.thickness->mean)}};
    }
    return entry;
}

std::string gridsJson(const std::filesystem::path& file, const std::vector<vdb::GridInfo>& grids) {
    Json list = Json::array();
    for (const vdb::GridInfo& grid : grids) list.push_back(gridJson(grid));
    return dumped({{"file", file.string()}, {"grids", list}});
}

std::string triple(const auto& v, const char* between) {
    return fmt::format("{:.9g}{}{:.9g}{}{:.9g}", static_cast<double>(v.x), between, static_cast<double>(v.y), between,
                       static_cast<double>(v.z));
}

std::string rounded(const glm::dvec3& v) {
    return fmt::format("{:.4g} x {:.4g} x {:.4g}", v.x, v.y, v.z);
}

std::string placeText(const vdb::Place& place) {
    std::string text =
        fmt::format("  metres    from {} to {}\n", triple(place.minimum, " "), triple(place.maximum, " "));
    if (place.mirrored || place.rotated)
        text += fmt::format("  axes      {}{}{}: x of the grid goes along {}, y along {}, z along {}\n",
                            place.mirrored ? "mirrored" : "", place.mirrored && place.rotated ? " and " : "",
                            place.rotated ? "rotated" : "", triple(place.toWorld.linear[0], " "),
                            triple(place.toWorld.linear[1], " "), triple(place.toWorld.linear[2], " "));
    return text;
}

std::string gridText(const vdb::GridInfo& grid) {
    const glm::ivec3 extent = grid.activeMaximum - grid.activeMinimum + 1;
    std::string text = fmt::format("{}: {}, {}{}{}\n", shown(grid.name), shown(grid.type), grid.gridClass,
                                   grid.affine ? "" : ", transform not affine",
                                   grid.taken ? ", taken where a scene names no grid" : "");
    text += fmt::format("  voxels    {} active, in {} x {} x {}\n", grid.activeVoxels, extent.x, extent.y, extent.z);
    text +=
        fmt::format("  indices   from {} to {}\n", triple(grid.activeMinimum, " "), triple(grid.activeMaximum, " "));
    if (grid.place) text += placeText(*grid.place);
    text += fmt::format("  voxel     {} m\n", triple(grid.voxelSize, " x "));
    if (grid.values) {
        text += fmt::format("  values    {:.6g} to {:.6g}, mean {:.6g}, background {:.6g}\n", grid.values->minimum,
                            grid.values->maximum, grid.values->mean, grid.values->background);
        if (grid.values->notFinite > 0)
            text += fmt::format("            and {} that are infinite or not a number\n", grid.values->notFinite);
    }
    if (grid.bricks) {
        constexpr double slotMiB = 729.0 / 1048576.0, denseMiB = 1024.0 / 1048576.0;
        const auto filled = static_cast<double>(grid.bricks->first);
        text += fmt::format(
            "  bricks    {} of {:.0f} of 8^3 voxels: about {:.4g} MiB sparse at 1 byte a voxel, {:.4g} MiB dense at "
            "2\n",
            grid.bricks->first, grid.bricks->second, slotMiB * filled, denseMiB * grid.bricks->second);
    }
    if (grid.thickness)
        text += fmt::format(
            "  optical   thickness {} at most, {} on average, along the axes of the grid at extinction 1/m\n",
            rounded(grid.thickness->largest), rounded(grid.thickness->mean));
    return text;
}

std::string gridsText(const std::vector<vdb::GridInfo>& grids) {
    if (grids.empty()) return "no grids\n";
    std::string text;
    for (const vdb::GridInfo& grid : grids) text += gridText(grid);
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
