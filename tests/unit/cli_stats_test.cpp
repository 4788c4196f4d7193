#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "cli/stats_json.h"
#include "scene/schema.h"
#include "vdb/procedural.h"

namespace lumulus::cli {
namespace {

TEST(StatisticsJson, HasEveryNumberUnderItsName) {
    Statistics s;
    s.device = "a \"device\"\xff";  // not UTF-8
    s.loadSeconds = 0.5;
    s.prepareSeconds = 1.5;
    s.traceSeconds = 2.5;
    s.drawSeconds = 3.5;
    s.photons = 18446744073709551615ULL;
    s.generations = 2;
    s.events = 3;
    s.nullCollisions = 4;
    s.absorbed = 5;
    s.escaped = 6;
    s.lost = 7;
    s.saturated = 8;
    s.collectors = 9;
    s.gpuBytes = 10;
    s.gpuBytesHeld = 11;
    s.assets = {{{8, 9, 10}, 0, 7, 1, 0.5, 0.25, 0.125, 1.0, 2.0}, {{4, 5, 5}, 1, 2, 199, 0.5, 0.25, 0.125, 1.0, 2.0}};
    s.passes = {{"trace", 1.25}, {"draw", 2.0}};
    s.warnings = {"odd"};
    const std::string text = statisticsJson(s, {}, 4.5, 12.5);
    EXPECT_EQ(text.back(), '\n');
    const auto json = nlohmann::json::parse(text);
    EXPECT_EQ(json["device"], "a \"device\"\xef\xbf\xbd");
    EXPECT_EQ(json["seconds"],
              nlohmann::json(
                  {{"load", 0.5}, {"prepare", 1.5}, {"trace", 2.5}, {"draw", 3.5}, {"write", 4.5}, {"total", 12.5}}));
    EXPECT_EQ(json["photons"].get<std::uint64_t>(), 18446744073709551615ULL);
    int number = 2;
    for (const char* name : {"generations", "events", "null_collisions", "absorbed", "escaped", "lost", "saturated",
                             "collectors", "gpu_bytes", "gpu_bytes_held"}) {
        EXPECT_EQ(json[name], number++) << name;
    }
    EXPECT_EQ(
        json["preparation"],
        nlohmann::json({{"upload", 1.0}, {"majorants", 0.5}, {"sampling", 0.25}, {"tree", 2.0}, {"collectors", 4.0}}));
    EXPECT_EQ(json["assets"],
              nlohmann::json::array({{{"voxels", {8, 9, 10}}, {"level", 0}, {"collectors", 7}, {"instances", 1}},
                                     {{"voxels", {4, 5, 5}}, {"level", 1}, {"collectors", 2}, {"instances", 199}}}));
    EXPECT_EQ(json["passes"],
              nlohmann::json::array({{{"name", "trace"}, {"ms", 1.25}}, {{"name", "draw"}, {"ms", 2.0}}}));
    EXPECT_EQ(json["warnings"], nlohmann::json::array({"odd"}));
    EXPECT_FALSE(json.contains("progressive"));
}

TEST(StatisticsJson, SaysWhereAProgressivePictureStopped) {
    Statistics s;
    s.photons = 300;
    s.generations = 3;
    ProgressiveStatistics reached{"target-error", 0.25, 1.5};
    auto json = nlohmann::json::parse(statisticsJson(s, reached, 0.0, 0.0));
    EXPECT_EQ(json["progressive"], nlohmann::json({{"stop", "target-error"},
                                                   {"noise", 0.25},
                                                   {"photons", 300},
                                                   {"generations", 3},
                                                   {"preview_seconds", 1.5}}));
    reached.noise.reset();
    json = nlohmann::json::parse(statisticsJson(s, reached, 0.0, 0.0));
    EXPECT_TRUE(json["progressive"]["noise"].is_null());
}

TEST(SceneKinds, AreThoseOfTheProceduralClouds) {
    const std::vector<std::string> kinds = vdb::kinds();
    EXPECT_THAT(scene::findKey("cloud.procedural")->choices, testing::UnorderedElementsAreArray(kinds));
}

}  // namespace
}  // namespace lumulus::cli
