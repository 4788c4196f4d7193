#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "service/protocol/message.h"

namespace lumulus::service::test {

inline std::vector<std::byte> bytesOf(const std::string& text) {
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

inline std::vector<std::byte> encoded(const Message& message) {
    std::vector<std::byte> bytes = encodeHead(message);
    bytes.insert(bytes.end(), message.payload.begin(), message.payload.end());
    return bytes;
}

inline Message request(MessageType type, std::string json, std::vector<std::byte> payload = {}) {
    return {type, 7, std::move(json), std::move(payload)};
}

/// One valid message of every kind.
inline std::vector<Message> validMessages() {
    const std::string hash(64, 'a');
    return {
        request(MessageType::hello, R"({"version":1,"token":"secret","client":"test"})"),
        request(MessageType::loadScene, R"({"name":"cumulus.toml","set":["image.width=64"],"quality":"draft"})"),
        request(MessageType::loadScene, "{}", bytesOf("[image]\nwidth = 32\n")),
        request(MessageType::upload, R"({"hash":")" + hash + R"(","size":10,"offset":2})", bytesOf("eightbyt")),
        request(MessageType::frame, R"({"camera":{"position":[1,2,3],"target":[0,0,0],"vertical_fov":30},)"
                                    R"("width":64,"height":48,"tile":[0,0,32,24],"time":1.5,"channel":3,)"
                                    R"("sun":{"azimuth":10,"elevation":20,"irradiance":[1,2,3]},"extinction":0.1,)"
                                    R"("wind":[1,0,0],"budget":{"milliseconds":50},"encoding":"exr",)"
                                    R"("products":["color","depth"]})"),
        request(MessageType::frame, R"({"views":[{"camera":{"position":[0,0,0],"orientation":[1,0,0,0],)"
                                    R"("frustum":[-1,1,-1,1]},"width":8,"height":8},{"width":8,"height":8}]})"),
        request(MessageType::startStream, R"({"width":8,"height":8,"max_rate":10,"when":"change"})"),
        request(MessageType::stopStream, R"({"stream":3})"),
        request(MessageType::composite, R"({"width":1,"height":1})", std::vector<std::byte>(16)),
        request(MessageType::cancel, R"({"request":3})"),
        request(MessageType::statistics, "{}"),
        request(MessageType::ping, "{}"),
        request(MessageType::change, R"({"extinction":0.2})"),
        request(MessageType::change, R"({"clouds":[{"add":"b","like":0,"yaw":10},{"remove":"b"},{"cloud":0,"g":0}]})"),
        request(MessageType::listUploads, "{}"),
        request(MessageType::deleteUpload, R"({"hash":"sha256:)" + hash + R"("})"),
        request(MessageType::listScenes, "{}"),
        request(MessageType::query, R"({"products":["sun"]})", std::vector<std::byte>(24)),
        request(MessageType::query, R"({"products":["ground_shadow"],"rectangle":[0,0,1,1],"width":4,"height":3})"),
    };
}

}  // namespace lumulus::service::test
