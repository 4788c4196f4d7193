// From JSON to values: what is taken, and what is refused with the name of the field.
#include "service/protocol/requests.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "service/protocol/json_fields.h"
#include "support/service_messages.h"

namespace lumulus::service {
namespace {

using test::bytesOf;
using test::request;

/// "code: where" of the refusal; "taken" where there is none.
std::string refusal(const Message& message, const RequestLimits& limits = {}) {
    try {
        parseRequest(message, limits);
    } catch (const RequestError& e) {
        return e.code + ": " + e.where;
    }
    return "taken";
}

std::string frameRefusal(const std::string& json) {
    return refusal(request(MessageType::frame, json));
}

TEST(Requests, EveryKindIsTaken) {
    for (const Message& message : test::validMessages()) EXPECT_EQ(refusal(message), "taken") << message.json;
    EXPECT_EQ(refusal(request(MessageType::frame, "")), "taken");
}

TEST(Requests, AFrameSaysWhatItSays) {
    const Message message = test::validMessages().at(4);
    const auto frame = std::get<FrameRequest>(parseRequest(message, {}));
    EXPECT_EQ(frame.channel, 3U);
    ASSERT_EQ(frame.views.size(), 1U);
    EXPECT_EQ(frame.views[0].camera.position, glm::dvec3(1, 2, 3));
    EXPECT_EQ(frame.views[0].width, 64);
    EXPECT_EQ(frame.views[0].tile, (Tile{0, 0, 32, 24}));
    EXPECT_EQ(frame.time, 1.5);
    EXPECT_EQ(*frame.light.sunDirection, scene::skyDirection(10, 20));
    EXPECT_EQ(frame.light.sunIrradiance, glm::dvec3(1, 2, 3));
    EXPECT_EQ(frame.light.wind, glm::dvec3(1, 0, 0));
    EXPECT_EQ(frame.budget.milliseconds, 50.0);
    EXPECT_EQ(frame.format.encoding, Encoding::exr);
    EXPECT_THAT(frame.products, testing::ElementsAre(Product::color, Product::depth));
}

TEST(Requests, AStreamHasARateOrARhythm) {
    const auto stream = [](const char* json) { return request(MessageType::startStream, json); };
    const auto start = std::get<StartStream>(parseRequest(stream(R"({"every":33.3,"phase":12})"), {}));
    ASSERT_TRUE(start.rhythm);
    EXPECT_EQ(start.rhythm->every, 33.3);
    EXPECT_EQ(start.rhythm->phase, 12.0);
    EXPECT_EQ(std::get<StartStream>(parseRequest(stream(R"({"every":50})"), {})).rhythm->phase, 0.0);
    EXPECT_FALSE(std::get<StartStream>(parseRequest(stream(R"({"max_rate":5})"), {})).rhythm);
    EXPECT_EQ(refusal(stream(R"({"phase":12})")), "bad_request: phase");
    EXPECT_EQ(refusal(stream(R"({"every":50,"phase":-1})")), "bad_request: phase");
    EXPECT_EQ(refusal(stream(R"({"every":0})")), "bad_request: every");
    EXPECT_EQ(refusal(stream(R"({"every":1e9})")), "bad_request: every");
    EXPECT_EQ(refusal(stream(R"({"every":50,"max_rate":5})")), "bad_request: max_rate");
    EXPECT_EQ(refusal(request(MessageType::frame, R"({"every":50})")), "bad_request: every");
}

TEST(Requests, HostileFramesAreRefusedByField) {
    EXPECT_EQ(frameRefusal(R"({"camera":{"position":[1e999,0,0]}})"), "bad_request: ");
    EXPECT_EQ(frameRefusal(R"({"camera":{"position":[NaN,0,0]}})"), "bad_request: ");
    EXPECT_EQ(frameRefusal(R"({"camera":{"position":[null,0,0]}})"), "bad_request: camera.position");
    EXPECT_EQ(frameRefusal(R"({"camera":{"position":[1,2]}})"), "bad_request: camera.position");
    EXPECT_EQ(frameRefusal(R"({"camera":{"position":"here"}})"), "bad_request: camera.position");
    EXPECT_EQ(frameRefusal(R"({"camera":{"up":[0,0,0]}})"), "bad_request: camera.up");
    EXPECT_EQ(frameRefusal(R"({"camera":{"position":[0,0,0],"orientation":[0,0,0,0]}})"),
              "bad_request: camera.orientation");
    EXPECT_EQ(frameRefusal(R"({"camera":{"frustum":[1,-1,0,1]}})"), "bad_request: camera.frustum");
    EXPECT_EQ(frameRefusal(R"({"camera":[]})"), "bad_request: camera");
    EXPECT_EQ(frameRefusal(R"({"width":0,"height":0})"), "bad_request: width");
    EXPECT_EQ(frameRefusal(R"({"width":1000000000,"height":1000000000})"), "bad_request: width");
    EXPECT_EQ(frameRefusal(R"({"width":16384,"height":16384})"), "too_large: width");
    EXPECT_EQ(frameRefusal(R"({"width":2.5})"), "bad_request: width");
    EXPECT_EQ(frameRefusal(R"({"tile":[0.5,0,1,1]})"), "bad_request: tile");
    EXPECT_EQ(frameRefusal(R"({"budget":{"milliseconds":-1}})"), "bad_request: budget.milliseconds");
    EXPECT_EQ(frameRefusal(R"({"budget":{"photons":-5}})"), "bad_request: budget.photons");
    EXPECT_EQ(frameRefusal(R"({"budget":{"photons":5,"milliseconds":5}})"), "bad_request: budget");
    EXPECT_EQ(frameRefusal(R"({"products":["color","color"]})"), "bad_request: products");
    EXPECT_EQ(frameRefusal(R"({"products":["depth"],"encoding":"png"})"), "bad_request: products");
    EXPECT_EQ(frameRefusal(R"({"views":[]})"), "bad_request: views");
    EXPECT_EQ(frameRefusal(R"({"views":[{"camera":{"zoom":2}}]})"), "bad_request: views[0].camera.zoom");
    EXPECT_EQ(frameRefusal(R"({"width":8,"views":[{}]})"), "bad_request: views");
    EXPECT_EQ(frameRefusal(R"({"sun":{"azimuth":1,"direction_to":[0,1,0]}})"), "bad_request: sun");
    EXPECT_EQ(frameRefusal(R"({"extinction":-1})"), "bad_request: extinction");
    EXPECT_EQ(frameRefusal(R"({"wdith":8})"), "bad_request: wdith");
    EXPECT_EQ(frameRefusal("[1,2]"), "bad_request: ");
    EXPECT_EQ(frameRefusal("{\"a\":"), "bad_request: ");
}

TEST(Requests, JsonBombsAreRefused) {
    for (const char bracket : {'[', '{'}) {
        const std::string deep = "{\"a\":" + std::string(60000, bracket);
        EXPECT_EQ(frameRefusal(deep), "bad_request: ");
    }
    std::string wide = "{\"views\":[{}";
    for (int i = 0; i < 20000; ++i) wide += ",{}";
    EXPECT_EQ(frameRefusal(wide + "]}"), "bad_request: views");
    EXPECT_EQ(frameRefusal(R"({"a":"[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[\"[[[["})"), "bad_request: a");
}

TEST(Requests, LimitsAreThoseOfTheConfiguration) {
    RequestLimits limits;
    limits.pixels = 100;
    limits.views = 2;
    limits.uploadBytes = 10;
    EXPECT_EQ(refusal(request(MessageType::frame, R"({"width":10,"height":10})"), limits), "taken");
    EXPECT_EQ(refusal(request(MessageType::frame, R"({"width":11,"height":10})"), limits), "too_large: width");
    EXPECT_EQ(refusal(request(MessageType::frame, R"({"width":1000,"height":1000,"tile":[0,0,10,10]})"), limits),
              "taken");
    EXPECT_EQ(refusal(request(MessageType::frame, R"({"views":[{},{},{}]})"), limits), "bad_request: views");
    const std::string hash(64, '0');
    EXPECT_EQ(refusal(request(MessageType::upload, R"({"hash":")" + hash + R"(","size":11,"offset":0})"), limits),
              "too_large: size");
}

TEST(Requests, UploadsStayWithinTheirSize) {
    const auto upload = [](const std::string& hash, int size, int offset, const char* bytes) {
        return refusal(request(MessageType::upload,
                               R"({"hash":")" + hash + R"(","size":)" + std::to_string(size) + R"(,"offset":)" +
                                   std::to_string(offset) + "}",
                               bytesOf(bytes)));
    };
    const std::string hash(64, 'b');
    EXPECT_EQ(upload(hash, 4, 0, "abcd"), "taken");
    EXPECT_EQ(upload(hash, 4, 1, "abcd"), "bad_request: offset");
    EXPECT_EQ(upload(hash, 4, 5, ""), "bad_request: offset");
    EXPECT_EQ(upload("../../etc/passwd", 4, 0, "abcd"), "bad_request: hash");
    EXPECT_EQ(upload(std::string(64, 'B'), 4, 0, "abcd"), "bad_request: hash");
}

TEST(Requests, ACompositeHasItsPixels) {
    EXPECT_EQ(refusal(request(MessageType::composite, R"({"width":2,"height":1})", std::vector<std::byte>(31))),
              "bad_request: ");
    EXPECT_EQ(refusal(request(MessageType::composite, R"({"width":2,"height":1})", std::vector<std::byte>(32))),
              "taken");
    EXPECT_EQ(refusal(request(MessageType::composite, R"({"width":0,"height":1})")), "bad_request: width");
}

TEST(Requests, IdsHave64Bits) {
    const auto stream = [](const std::string& id) {
        return std::get<StopStream>(parseRequest(request(MessageType::stopStream, R"({"stream":)" + id + "}"), {}))
            .stream;
    };
    EXPECT_EQ(stream("18446744073709551615"), 18446744073709551615U);
    EXPECT_EQ(stream("9007199254740993"), 9007199254740993U);  // no double
    EXPECT_EQ(stream("3.0"), 3U);
    EXPECT_EQ(stream(R"("18446744073709551615")"), 18446744073709551615U);
    const Request cancel = parseRequest(request(MessageType::cancel, R"({"request":18446744073709551614})"), {});
    EXPECT_EQ(std::get<Cancel>(cancel).request, 18446744073709551614U);
    for (const char* bad : {"-1", "1.5", "18446744073709551616", R"("")", R"("1x")", R"("-1")", "true", "null", "[1]"})
        EXPECT_EQ(refusal(request(MessageType::stopStream, R"({"stream":)" + std::string(bad) + "}")),
                  "bad_request: stream")
            << bad;
}

TEST(Requests, AKeyTwiceIsAnError) {
    EXPECT_EQ(frameRefusal(R"({"width":8,"width":9})"), "bad_request: width");
    EXPECT_EQ(frameRefusal(R"({"camera":{"vertical_fov":30,"vertical_fov":30}})"), "bad_request: vertical_fov");
    EXPECT_EQ(frameRefusal(R"({"views":[{"width":8,"height":8},{"width":8,"height":8}],"time":1})"), "taken");
    EXPECT_EQ(frameRefusal(R"({"w\u0069dth":8,"width":9})"), "bad_request: width");
}

TEST(Requests, AHashIsSpelledAsInReplies) {
    const std::string digits(64, 'b');
    const auto remove = [](const std::string& hash) {
        return refusal(request(MessageType::deleteUpload, R"({"hash":")" + hash + R"("})"));
    };
    EXPECT_EQ(remove("sha256:" + digits), "taken");
    EXPECT_EQ(remove(digits), "taken");
    EXPECT_EQ(remove("md5:" + digits), "bad_request: hash");
    EXPECT_EQ(remove("sha256:sha256:" + digits), "bad_request: hash");
    EXPECT_EQ(digitsOfHash("sha256:" + digits), digits);
    const Request load =
        parseRequest(request(MessageType::loadScene, R"({"name":"x","vdb":"sha256:)" + digits + R"("})"), {});
    EXPECT_EQ(std::get<LoadScene>(load).vdb, digits);
}

TEST(Requests, ASceneIsAsSmallAsAFileOfOne) {
    EXPECT_EQ(refusal(request(MessageType::loadScene, "{}", std::vector<std::byte>((1U << 20U) + 1))), "too_large: ");
}

TEST(Requests, AChangeMayListMedia) {
    const auto change = [](const std::string& json) {
        return std::get<Change>(parseRequest(request(MessageType::change, json.c_str()), {}));
    };
    const auto refused = [](const std::string& json) { return refusal(request(MessageType::change, json.c_str())); };
    const Change asked = change(
        R"({"media":[{"medium":3,"visibility":800,"albedo":[1,0.5,1e-3],"aerosol":"urb\"an","g":null},
                     {"medium":0,"original":true}]})");
    ASSERT_EQ(asked.media.size(), 2U);
    EXPECT_EQ(asked.media[0].medium, 3U);
    EXPECT_FALSE(asked.media[0].original);
    EXPECT_EQ(asked.media[0].keys,
              (std::map<std::string, std::string>{
                  {"aerosol", R"("urb\"an")"}, {"albedo", "[1,0.5,0.001]"}, {"visibility", "800"}}));
    EXPECT_EQ(asked.media[1].medium, 0U);
    EXPECT_TRUE(asked.media[1].original && asked.media[1].keys.empty());
    for (const auto& [edit, where] : std::initializer_list<std::pair<const char*, const char*>>{
             {R"({"g":0})", "media[0].medium"},
             {R"({"medium":256,"g":0})", "media[0].medium"},
             {R"({"medium":0.5,"g":0})", "media[0].medium"},
             {R"({"medium":0})", "media[0]"},
             {R"({"medium":0,"original":false})", "media[0]"},
             {R"({"medium":0,"kind":"box"})", "media[0].kind"},
             {R"({"medium":0,"g=1,x":0})", "media[0].g=1,x"},
             {R"({"medium":0,"g":true})", "media[0].g"},
             {R"({"medium":0,"g":{}})", "media[0].g"},
             {R"({"medium":0,"albedo":[1,1]})", "media[0].albedo"},
             {R"({"medium":0,"albedo":[1,1,"1"]})", "media[0].albedo"},
             {R"(7)", "media[0]"},
             {R"({"medium":0,"g":0},{"medium":0,"g":1})", "media[1].medium"}})
        EXPECT_EQ(refused("{\"media\":[" + std::string(edit) + "]}"), "bad_request: " + std::string(where)) << edit;
    EXPECT_EQ(refused(R"({"media":[{"medium":0,"aerosol":")" + std::string(61, 'a') + "\"}]}"),
              "bad_request: media[0].aerosol");
    EXPECT_EQ(refused(R"({"media":[]})"), "bad_request: media");
    EXPECT_EQ(refused(R"({"media":{}})"), "bad_request: media");
    EXPECT_EQ(refused(R"({"media":[{"medium":0,"g":0}],"extinction":1})"), "bad_request: media");
    EXPECT_EQ(refused(R"({"media":[{"medium":0,"g":0}],"frame":1})"), "bad_request: media");
}

TEST(Requests, AChangeMayGiveACloudAnotherDensity) {
    const std::string hash(64, 'a');
    const auto change = [](const std::string& json) {
        return std::get<Change>(parseRequest(request(MessageType::change, json.c_str()), {}));
    };
    const auto refused = [](const std::string& json) { return refusal(request(MessageType::change, json.c_str())); };
    Change asked = change(R"({"cloud":"c","vdb":"sha256:)" + hash + R"(","grid":"smoke","seconds":0.5})");
    EXPECT_EQ(asked.cloud, CloudReference("c"));
    EXPECT_EQ(asked.density->vdb, hash);
    EXPECT_EQ(asked.density->grid, "smoke");
    EXPECT_EQ(asked.density->seconds, 0.5);
    EXPECT_FALSE(asked.density->frame);
    asked = change(R"({"frame":2.5})");
    EXPECT_EQ(asked.density->frame, 2.5);
    EXPECT_TRUE(asked.density->vdb.empty());
    EXPECT_FALSE(asked.cloud);
    EXPECT_FALSE(change(R"({"extinction":0.1})").density);
    EXPECT_EQ(refused(R"({"vdb":"../a.vdb"})"), "bad_request: vdb");
    EXPECT_EQ(refused(R"({"frame":1,"vdb":")" + hash + "\"}"), "bad_request: frame");
    EXPECT_EQ(refused(R"({"frame":1e10})"), "bad_request: frame");
    EXPECT_EQ(refused(R"({"frame":1,"seconds":1})"), "bad_request: seconds");
    EXPECT_EQ(refused(R"({"vdb":")" + hash + R"(","seconds":-1})"), "bad_request: seconds");
    EXPECT_EQ(refused(R"({"grid":"density"})"), "bad_request: grid");
    EXPECT_EQ(refused(R"({"frame":1,"extinction":1})"), "bad_request: frame");
    EXPECT_EQ(refused(R"({"frame":1,"clouds":[{"remove":0}]})"), "bad_request: frame");
    EXPECT_EQ(refusal(request(MessageType::frame, R"({"frame":1})")), "bad_request: frame");
}

TEST(Requests, AChangeMayNameTheCloudOfItsExtinction) {
    const auto change = [](const char* json) {
        return std::get<Change>(parseRequest(request(MessageType::change, json), {}));
    };
    EXPECT_FALSE(change(R"({"extinction":0.1})").cloud);
    EXPECT_EQ(change(R"({"extinction":0.1,"cloud":2})").cloud, CloudReference(2U));
    EXPECT_EQ(change(R"({"extinction":0.1,"cloud":"west"})").cloud, CloudReference("west"));
    EXPECT_EQ(refusal(request(MessageType::change, R"({"extinction":0.1,"cloud":-1})")), "bad_request: cloud");
    EXPECT_EQ(refusal(request(MessageType::change, R"({"extinction":0.1,"cloud":[0]})")), "bad_request: cloud");
    EXPECT_EQ(refusal(request(MessageType::change, R"({"wind":[1,0,0],"cloud":0})")), "bad_request: cloud");
    EXPECT_EQ(change(R"({"move":[1,2,3],"cloud":"west"})").light.move, glm::dvec3(1, 2, 3));
    EXPECT_EQ(refusal(request(MessageType::change, R"({"move":[1,2,3]})")), "bad_request: move");
    EXPECT_EQ(refusal(request(MessageType::frame, R"({"move":[1,2,3]})")), "bad_request: move");
    EXPECT_EQ(refusal(request(MessageType::frame, R"({"extinction":0.1,"cloud":0})")), "bad_request: cloud");
}

TEST(Requests, AChangeListsWhatBecomesOfClouds) {
    const auto change = [](const char* json) {
        return std::get<Change>(parseRequest(request(MessageType::change, json), {})).edits;
    };
    const auto refused = [](const std::string& list) {
        return refusal(request(MessageType::change, R"({"clouds":)" + list + "}"));
    };
    const std::vector<CloudEdit> edits = change(
        R"({"clouds":[{"add":"b","like":"a","move":[1,2,3],"yaw":90,"scale":2,"albedo":[1,0.5,0]},{"remove":0},
                      {"cloud":"b","g":0.5,"extinction":0.1}]})");
    ASSERT_EQ(edits.size(), 3U);
    EXPECT_EQ(edits[0].kind, CloudEdit::Kind::add);
    EXPECT_EQ(edits[0].name, "b");
    EXPECT_EQ(edits[0].cloud, CloudReference("a"));
    EXPECT_EQ(edits[0].move, glm::dvec3(1, 2, 3));
    EXPECT_EQ(edits[0].albedo, glm::dvec3(1, 0.5, 0));
    EXPECT_EQ(edits[0].yaw, 90.0);
    EXPECT_EQ(edits[0].scale, 2.0);
    EXPECT_EQ(edits[1].kind, CloudEdit::Kind::remove);
    EXPECT_EQ(edits[1].cloud, CloudReference(0U));
    EXPECT_EQ(edits[2].kind, CloudEdit::Kind::alter);
    EXPECT_EQ(edits[2].asymmetry, 0.5);
    EXPECT_EQ(edits[2].extinction, 0.1);
    EXPECT_EQ(refused("[]"), "bad_request: clouds");
    EXPECT_EQ(refused("[1]"), "bad_request: clouds[0]");
    EXPECT_EQ(refused("[{}]"), "bad_request: clouds[0].cloud");
    EXPECT_EQ(refused(R"([{"add":"b","remove":"a"}])"), "bad_request: clouds[0].cloud");
    EXPECT_EQ(refused(R"([{"add":"b"}])"), "bad_request: clouds[0].like");
    EXPECT_EQ(refused(R"([{"add":"","like":"a"}])"), "bad_request: clouds[0].add");
    EXPECT_EQ(refused(R"([{"remove":"a","g":0}])"), "bad_request: clouds[0].g");
    EXPECT_EQ(refused(R"([{"cloud":"a"}])"), "bad_request: clouds[0].cloud");
    EXPECT_EQ(refused(R"([{"cloud":"a","yaw":1,"g":0}])"), "bad_request: clouds[0].yaw");
    EXPECT_EQ(refused(R"([{"cloud":"a","g":1}])"), "bad_request: clouds[0].g");
    EXPECT_EQ(refused(R"([{"cloud":"a","move":[1e999,0,0]}])"), "bad_request: ") << "JSON has no such number";
    EXPECT_EQ(refused(R"([{"cloud":"a","move":[1e10,0,0]}])"), "bad_request: clouds[0].move");
    EXPECT_EQ(refused(R"([{"add":"b","like":"a","scale":0}])"), "bad_request: clouds[0].scale");
    EXPECT_EQ(refused(R"([{"cloud":"a","g":0}],"extinction":0.1)"), "bad_request: clouds");
}

TEST(Requests, AQueryNamesItsProductAndItsPlaces) {
    const auto query = std::get<QueryRequest>(parseRequest(
        request(MessageType::query, R"({"products":["ground_shadow"],"rectangle":[-1,-2,3,4],"y":5})"), {}));
    EXPECT_EQ(query.product, QueryProduct::groundShadow);
    EXPECT_THAT(query.rectangle, testing::ElementsAre(-1.0, -2.0, 3.0, 4.0));
    EXPECT_EQ(query.y, 5.0);
    const auto refused = [](const char* json, std::size_t bytes) {
        return refusal(request(MessageType::query, json, std::vector<std::byte>(bytes)));
    };
    EXPECT_EQ(refused(R"({"products":["segments"]})", 96), "taken");
    EXPECT_EQ(refused(R"({"products":["segments"]})", 0), "bad_request: ");
    EXPECT_EQ(refused(R"({"products":["segments"]})", 24), "bad_request: ");
    EXPECT_EQ(refused(R"({"products":["sun"]})", (mostQueryWays + 1) * 24), "too_large: ");
    EXPECT_EQ(refused(R"({"products":["ambient"]})", mostAmbientPoints * 24), "taken");
    EXPECT_EQ(refused(R"({"products":["ambient"]})", (mostAmbientPoints + 1) * 24), "too_large: ");
    EXPECT_EQ(refused("{}", 24), "bad_request: products");
    EXPECT_EQ(refused(R"({"products":["sun","segments"]})", 24), "bad_request: products");
    EXPECT_EQ(refused(R"({"products":["ground_shadow"],"rectangle":[0,0,1,1]})", 8), "bad_request: ");
    EXPECT_EQ(refused(R"({"products":["ground_shadow"],"rectangle":[0,0,1]})", 0), "bad_request: rectangle");
}

TEST(Requests, ScenesAreListedWithoutAnyField) {
    EXPECT_EQ(refusal(request(MessageType::listScenes, "{}")), "taken");
    EXPECT_EQ(refusal(request(MessageType::listScenes, R"({"folder":".."})")), "bad_request: folder");
}

TEST(Requests, PayloadsAndTypesThatNobodyKnowsAreRefused) {
    EXPECT_EQ(refusal(request(MessageType::frame, "{}", bytesOf("x"))), "bad_request: ");
    for (const int type : {0, 16, 77, 0x7FFF, 0x8000, 0x8004, 0xFFFF})
        EXPECT_EQ(refusal(request(static_cast<MessageType>(type), "{}")), "unknown_type: ") << type;
}

}  // namespace
}  // namespace lumulus::service
