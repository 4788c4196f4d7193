// Results as messages.
#include "service/protocol/replies.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "base/pass_time.h"

namespace lumulus::service {
namespace {

using nlohmann::json;

FrameResult drawn() {
    FrameResult result;
    result.shown.name = "small.toml";
    result.shown.photons = {3, 4, 2, 100};
    result.views.resize(1);
    result.views[0].drawnWidth = 8;
    result.views[0].drawnHeight = 4;
    result.waitedMilliseconds = 1.0;
    result.drawMilliseconds = 20.0;
    result.passes = {{"march", 5.0, Stage::draw},
                     {"march", 6.0, Stage::draw},
                     {"trace", 2.0, Stage::photons},
                     {"gather", 1.0, Stage::photons}};
    return result;
}

json reply(const FrameRequest& request, const FrameResult& result, double total) {
    EncodedPictures pictures;
    pictures.views.push_back({{"width", 16}});
    const Message message = frameReply({7, true, 5}, request, result, std::move(pictures), {3.0, total});
    EXPECT_EQ(message.type, replyTo(MessageType::startStream));
    EXPECT_EQ(message.id, 7U);
    return json::parse(message.json);
}

TEST(Replies, AFrameTellsItsTimesByStageAndByPass) {
    FrameRequest request;
    request.channel = 2;
    const json body = reply(request, drawn(), 30.0);
    EXPECT_EQ(body["milliseconds"], json::parse(R"({"waited":1.0,"trace":3.0,"draw":20.0,"encode":3.0,"total":30.0,
        "passes":{"march":11.0,"trace":2.0,"gather":1.0}})"));
    EXPECT_EQ(body["photons"], 400);
    EXPECT_EQ(body["current_generations"], 2);
    EXPECT_EQ(body["channel"], 2);
    EXPECT_EQ(body["number"], 5);
    EXPECT_EQ(body["views"][0]["width"], 16);
    EXPECT_EQ(body["views"][0]["drawn_width"], 8);
    EXPECT_TRUE(body["noise"].is_null());
    EXPECT_TRUE(body["hash"].is_null());
}

TEST(Replies, HelloTellsWhetherLightIsShared) {
    Welcome welcome;
    EXPECT_EQ(json::parse(welcomeText(welcome))["shared_light"], false);
    welcome.sharedLight = true;
    EXPECT_EQ(json::parse(welcomeText(welcome))["shared_light"], true);
}

TEST(Replies, ABudgetCountsTheEncoding) {
    FrameRequest request;
    EXPECT_EQ(reply(request, drawn(), 30.0)["budget_met"], true);
    request.budget.milliseconds = 30.0;
    EXPECT_EQ(reply(request, drawn(), 30.0)["budget_met"], true);
    EXPECT_EQ(reply(request, drawn(), 30.5)["budget_met"], false);
    request.budget = {};
    request.budget.photons = 401;
    EXPECT_EQ(reply(request, drawn(), 1.0)["budget_met"], false);
}

TEST(Replies, AnswersHaveTheTypeOfTheirRequest) {
    const auto type = [](const Reply& reply) { return encodeReply(1, reply).type; };
    EXPECT_EQ(type(SceneDescription{}), replyTo(MessageType::loadScene));
    EXPECT_EQ(type(StreamStopped{}), replyTo(MessageType::stopStream));
    EXPECT_EQ(type(FrameCancelled{}), replyTo(MessageType::cancel));
    EXPECT_EQ(type(LightChanged{}), replyTo(MessageType::change));
    EXPECT_EQ(type(DensityChanged{}), replyTo(MessageType::change));
    EXPECT_EQ(type(QueryAnswer{}), replyTo(MessageType::query));
    const Message failure = encodeReply(1, Failure{"busy", "too many", "streams"});
    EXPECT_EQ(failure.type, MessageType::error);
    EXPECT_EQ(json::parse(failure.json), json::parse(R"({"code":"busy","message":"too many","where":"streams"})"));
}

TEST(Replies, AnotherDensityIsToldWithWhatIsDrawn) {
    DensityChanged changed;
    changed.scene.name = "a.toml";
    changed.clouds = {{"c", std::string(64, 'a'), {}}, {"d", {}, 2.5}};
    changed.photons.generations = 20;
    changed.photons.current = 1;
    changed.carried = true;
    const json body = json::parse(encodeReply(1, changed).json);
    EXPECT_EQ(body["scene"]["name"], "a.toml");
    EXPECT_EQ(body["clouds"][0], (json{{"name", "c"}, {"vdb", "sha256:" + std::string(64, 'a')}}));
    EXPECT_EQ(body["clouds"][1], (json{{"name", "d"}, {"file", 2.5}}));
    EXPECT_EQ(body["generations"], 20);
    EXPECT_EQ(body["current_generations"], 1);
    EXPECT_EQ(body["carried"], true);
}

TEST(Replies, StatisticsHaveTheSceneWhereThereIsOne) {
    EXPECT_EQ(statisticsReply(1, {{"frames_total", 3}}, std::nullopt).json, R"({"frames_total":3})");
    const SceneLight light{{0.0, 1.0, 0.0}, {1.0, 2.0, 3.0}, 0.5};
    const Message message = statisticsReply(1, {}, SceneState{"small.toml", {0, 4, 4, 100}, 20, 1.5, light});
    const json scene = json::parse(message.json)["scene"];
    EXPECT_EQ(scene["photons"], 400);
    EXPECT_EQ(scene["sun"], json::parse(R"({"direction_to":[0.0,1.0,0.0],"irradiance":[1.0,2.0,3.0]})"));
    EXPECT_EQ(scene["extinction"], 0.5);
}

TEST(Replies, UploadsAreSpelledAsInRequests) {
    const std::string hash(64, 'a');
    const json body = json::parse(uploadsReply(1, {{hash, 10, 1.5}, {hash, 20, 0.0}}, 100).json);
    EXPECT_EQ(body["uploads"][0], (json{{"hash", "sha256:" + hash}, {"bytes", 10}, {"seconds_left", 1.0}}));
    EXPECT_EQ(body["bytes"], 30);
    EXPECT_EQ(body["most_bytes"], 100);
    EXPECT_EQ(uploadDeletedReply(1, true).json, R"({"found":true})");
}

TEST(Replies, StatisticsTellHowFarALoadIs) {
    const Message message = statisticsReply(1, {}, std::nullopt, LoadState{"preparing the cloud", 1.5});
    EXPECT_EQ(json::parse(message.json), json::parse(R"({"loading":{"step":"preparing the cloud","seconds":1.5}})"));
}

TEST(Replies, ScenesAreAListOfNames) {
    const Message message = scenesReply(9, {"a.toml", "é.toml"});
    EXPECT_EQ(message.type, replyTo(MessageType::listScenes));
    EXPECT_EQ(message.id, 9U);
    EXPECT_EQ(json::parse(message.json), json::parse(R"({"scenes":["a.toml","é.toml"]})"));
}

TEST(Replies, ASceneTellsWhatItsFileSays) {
    SceneDescription scene;
    scene.originalSun.directionTo = {0.0, 1.0, 0.0};
    scene.originalSun.irradiance = {1.0, 2.0, 3.0};
    scene.originalClouds = {{"west", 0.5, 0.25}, {"1", 0.125, std::nullopt}};
    scene.originalMedia.resize(2);
    scene.originalMedia[0].scattering = glm::dvec3(3.912);
    scene.originalMedia[0].top = 50.0;
    scene.originalMedia[1].kind = scene::MediumKind::exponential;
    scene.originalMedia[1].g = 0.5;
    scene.originalMedia[1].falloff = 0.25;
    EXPECT_EQ(json::parse(encodeReply(1, scene).json)["original"], json::parse(R"({
        "media":[{"kind":"homogeneous","scattering":[3.912,3.912,3.912],"absorption":[0.0,0.0,0.0],"g":0.9,
                  "visibility":1.0,"top":50.0},
                 {"kind":"exponential","scattering":[0.0,0.0,0.0],"absorption":[0.0,0.0,0.0],"g":0.5,"falloff":0.25}],
        "sun":{"direction_to":[0.0,1.0,0.0],"irradiance":[1.0,2.0,3.0]},
        "clouds":[{"name":"west","extinction":0.5,"g":0.25},{"name":"1","extinction":0.125}]})"));
}

}  // namespace
}  // namespace lumulus::service
