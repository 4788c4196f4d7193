#include "cli/stats_json.h"

#include <nlohmann/json.hpp>
#include <span>

#include "base/atomic_file.h"
#include "base/error.h"
#include "cli/output.h"

namespace lumulus::cli {

using Json = nlohmann::ordered_json;

namespace {

Json bricksJson(const BrickSummary& bricks) {
    return {{"leaves", bricks.leaves},
            {"dense", bricks.dense},
            {"constant", bricks.constant},
            {"empty", bricks.empty},
            {"slots_by_level", bricks.levels},
            {"bytes",
             {{"texel", bricks.bytesOfTexel},
              {"pool", bricks.poolBytes},
              {"index", bricks.indexBytes},
              {"collector_index", bricks.collectorIndexBytes},
              {"majorants", bricks.majorantBytes}}}};
}

Json assetsJson(const std::vector<AssetSummary>& assets) {
    Json result = Json::array();
    for (const AssetSummary& asset : assets)
        result.push_back({{"voxels", asset.voxels},
                          {"level", asset.level},
                          {"collectors", asset.collectors},
                          {"instances", asset.instances}});
    return result;
}

/// Seconds of the parts of the preparation, of all assets.
Json preparationJson(const std::vector<AssetSummary>& assets) {
    const auto sum = [&](double AssetSummary::*part) {
        double seconds = 0.0;
        for (const AssetSummary& asset : assets) seconds += asset.*part;
        return seconds;
    };
    return {{"upload", sum(&AssetSummary::upload)},
            {"majorants", sum(&AssetSummary::majorants)},
            {"sampling", sum(&AssetSummary::sampling)},
            {"tree", sum(&AssetSummary::tree)},
            {"collectors", sum(&AssetSummary::collecting)}};
}

}  // namespace

std::string statisticsJson(const Statistics& s, const std::optional<ProgressiveStatistics>& progressive,
                           double writeSeconds, double totalSeconds, const ErrorOfPicture* error) {
    Json passes = Json::array();
    for (const PassTime& pass : s.passes) passes.push_back({{"name", pass.name}, {"ms", pass.milliseconds}});
    Json clouds = Json::array();
    for (const CloudSummary& cloud : s.clouds) {
        clouds.push_back({{"name", cloud.name},
                          {"file", cloud.file.empty() ? Json() : Json(cloud.file)},
                          {"grid", cloud.grid},
                          {"optical_thickness", {{"largest", cloud.largestThickness}, {"mean", cloud.meanThickness}}}});
        if (cloud.bricks) clouds.back()["bricks"] = bricksJson(*cloud.bricks);
    }
    Json json{
        {"device", s.device},
        {"clouds", clouds},
        {"seconds",
         {{"load", s.loadSeconds},
          {"prepare", s.prepareSeconds},
          {"trace", s.traceSeconds},
          {"draw", s.drawSeconds},
          {"write", writeSeconds},
          {"total", totalSeconds}}},
        {"preparation", preparationJson(s.assets)},
        {"assets", assetsJson(s.assets)},
        {"photons", s.photons},
        {"generations", s.generations},
        {"events", s.events},
        {"null_collisions", s.nullCollisions},
        {"absorbed", s.absorbed},
        {"escaped", s.escaped},
        {"lost", s.lost},
        {"saturated", s.saturated},
        {"collectors", s.collectors},
        {"gpu_bytes", s.gpuBytes},
        {"gpu_bytes_held", s.gpuBytesHeld},
        {"passes", passes},
        {"warnings", s.warnings},
        {"validation_messages", s.validationMessages},
    };
    if (progressive) {
        json["progressive"] = {{"stop", progressive->stop},
                               {"noise", progressive->noise ? Json(*progressive->noise) : Json()},
                               {"photons", s.photons},
                               {"generations", s.generations},
                               {"preview_seconds", progressive->previewSeconds}};
    }
    if (s.fogChangeBytes > 0) json["fog_change_bytes"] = s.fogChangeBytes;
    if (error != nullptr) error->addTo(json);
    // names of devices and files may hold bytes that are no UTF-8
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void writeStatistics(const std::string& where, const std::string& json) {
    if (where == "-") {
        printOut(json);
    } else if (!where.empty()) {
        writeFile(where, std::as_bytes(std::span(json)));
    }
}

void requireNoMessages(bool validate, const Statistics& statistics) {
    if (!validate || statistics.validationMessages.empty()) return;
    throw Error("Vulkan validation: " + statistics.validationMessages.front(), statistics.device,
                "this is a mistake of Lumulus: please report it");
}

}  // namespace lumulus::cli
