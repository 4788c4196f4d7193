#include "service/protocol/requests.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "service/protocol/cloud_edit_fields.h"
#include "service/protocol/density_fields.h"
#include "service/protocol/frame_fields.h"
#include "service/protocol/media_fields.h"
#include "service/protocol/query_fields.h"

namespace lumulus::service {

using nlohmann::json;

namespace {

constexpr std::size_t longestName = 200, longestOverride = 1000, mostOverrides = 64;
constexpr std::size_t largestScene = std::size_t{1} << 20U;  // bytes of TOML, as in scene files

Hello readHello(JsonFields& fields) {
    const auto version = fields.integer("version", 0, 65535);
    if (version.value_or(protocolVersion) != protocolVersion)
        throw RequestError("unsupported_version", "only version 1 of the protocol is spoken here", "version");
    return {fields.text("token", longestName).value_or(""), fields.text("client", longestName).value_or("")};
}

LoadScene readLoadScene(JsonFields& fields, const std::vector<std::byte>& payload) {
    LoadScene load;
    load.name = fields.text("name", longestName).value_or("");
    if (payload.size() > largestScene) throw RequestError("too_large", "a scene may hold 1 MiB of TOML");
    load.toml.assign(reinterpret_cast<const char*>(payload.data()), payload.size());
    if (load.name.empty() && load.toml.empty())
        throw RequestError("bad_request", "give the name of a scene, or its TOML as payload", "name");
    if (!load.name.empty() && !load.toml.empty())
        throw RequestError("bad_request", "give the name of a scene or its TOML, not both", "name");
    if (const auto vdb = fields.text("vdb", longestName); vdb && !vdb->empty()) load.vdb = requireHash(*vdb, "vdb");
    load.overrides = fields.texts("set", mostOverrides, longestOverride).value_or(std::vector<std::string>{});
    if (const auto quality = fields.choice("quality", {"draft", "interactive", "final"}))
        load.quality = static_cast<scene::Quality>(*quality);
    load.isPrivate = fields.flag("private").value_or(false);
    return load;
}

Upload readUpload(JsonFields& fields, std::vector<std::byte> payload, const RequestLimits& limits) {
    Upload upload;
    upload.hash = requireHash(fields.requiredText("hash", longestName), "hash");
    upload.size = fields.requiredCount("size", std::uint64_t{1} << 53U);
    if (upload.size > limits.uploadBytes)
        throw RequestError("too_large", "an upload may hold " + std::to_string(limits.uploadBytes) + " bytes here",
                           "size");
    upload.offset = fields.requiredCount("offset", std::uint64_t{1} << 53U);
    upload.bytes = std::move(payload);
    if (upload.offset > upload.size || upload.bytes.size() > upload.size - upload.offset)
        throw RequestError("bad_request", "the chunk goes beyond the size of the upload", "offset");
    return upload;
}

std::optional<Rhythm> readRhythm(JsonFields& fields) {
    constexpr double longest = 1e5;  // milliseconds, as of the slowest max_rate
    const auto every = fields.number("every", 1.0, longest);
    const auto phase = fields.number("phase", 0.0, longest);
    if (phase && !every)
        throw RequestError("bad_request", "a phase goes with the milliseconds between frames: give every", "phase");
    if (!every) return std::nullopt;
    return Rhythm{*every, phase.value_or(0.0)};
}

StartStream readStartStream(JsonFields& fields, const RequestLimits& limits) {
    StartStream start;
    start.frame = readFrame(fields, limits);
    const auto rate = fields.number("max_rate", 0.01, 1000.0);
    start.maxRate = rate.value_or(start.maxRate);
    start.rhythm = readRhythm(fields);
    if (rate && start.rhythm)
        throw RequestError("bad_request", "a stream has a max_rate, or moments by every, not both", "max_rate");
    start.onChange = fields.choice("when", {"always", "change"}).value_or(0) == 1;
    return start;
}

Composite readComposite(JsonFields& fields, std::vector<std::byte> payload, const RequestLimits& limits) {
    Composite composite;
    composite.width = static_cast<int>(fields.requiredCount("width", 16384));
    composite.height = static_cast<int>(fields.requiredCount("height", 16384));
    const std::uint64_t pixels =
        static_cast<std::uint64_t>(composite.width) * static_cast<std::uint64_t>(composite.height);
    if (pixels == 0) throw RequestError("bad_request", "the picture has no pixels", "width");
    if (pixels > limits.pixels)
        throw RequestError("too_large", "a picture may hold " + std::to_string(limits.pixels) + " pixels here",
                           "width");
    if (const json* camera = fields.object("camera")) {
        JsonFields inner(*camera, "camera");
        composite.camera = readCamera(inner);
        inner.finish();
    }
    composite.format = readFormat(fields);
    if (payload.size() != pixels * 4 * sizeof(float))
        throw RequestError("bad_request", "the payload must be 3 floats of colour a pixel, then 1 of depth a pixel");
    composite.pixels = std::move(payload);
    return composite;
}

Change readChange(JsonFields& fields) {
    Change change;
    change.light = readLight(fields);
    change.light.move = fields.vector("move", -1e9, 1e9);
    change.edits = readCloudEdits(fields);
    change.density = readDensity(fields);
    change.media = readMedia(fields);
    if (change.light.empty() && change.edits.empty() && !change.density && change.media.empty())
        throw RequestError("bad_request",
                           "nothing to change: give sun, extinction, wind, move, clouds, media, vdb or frame");
    if (!change.media.empty() && !(change.light.empty() && change.edits.empty() && !change.density))
        throw RequestError("bad_request", "media change by themselves, without other changes", "media");
    change.cloud = fields.indexOrName("cloud", 65535, longestName);
    if (change.density && !(change.edits.empty() && change.light.empty()))
        throw RequestError("bad_request", "another density goes by itself, without other changes",
                           change.density->vdb.empty() ? "frame" : "vdb");
    if (change.cloud && !change.density && !change.light.extinction && !change.light.move)
        throw RequestError("bad_request", "a cloud is named with an extinction for it or with a move", "cloud");
    if (!change.edits.empty() && (change.cloud || !change.light.empty()))
        throw RequestError("bad_request", "changes of clouds go by themselves, without sun, extinction, wind and move",
                           "clouds");
    if (change.light.move && !change.cloud)
        throw RequestError("bad_request", "a move needs the cloud that moves", "move");
    return change;
}

Request readRequest(Message& message, JsonFields& fields, const RequestLimits& limits) {
    switch (message.type) {
        case MessageType::hello:
            return readHello(fields);
        case MessageType::loadScene:
            return readLoadScene(fields, message.payload);
        case MessageType::upload:
            return readUpload(fields, std::move(message.payload), limits);
        case MessageType::frame:
            return readFrame(fields, limits);
        case MessageType::startStream:
            return readStartStream(fields, limits);
        case MessageType::stopStream:
            return StopStream{fields.requiredId("stream")};
        case MessageType::composite:
            return readComposite(fields, std::move(message.payload), limits);
        case MessageType::cancel:
            return Cancel{fields.requiredId("request")};
        case MessageType::statistics:
            return StatisticsRequest{};
        case MessageType::ping:
            return Ping{};
        case MessageType::change:
            return readChange(fields);
        case MessageType::listUploads:
            return ListUploads{};
        case MessageType::deleteUpload:
            return DeleteUpload{requireHash(fields.requiredText("hash", longestName), "hash")};
        case MessageType::listScenes:
            return ListScenes{};
        case MessageType::query:
            return readQuery(fields, message.payload);
        case MessageType::error:
            break;
    }
    throw RequestError("unknown_type",
                       "there is no message of type " + std::to_string(static_cast<std::uint16_t>(message.type)));
}

bool takesPayload(MessageType type) {
    return type == MessageType::loadScene || type == MessageType::upload || type == MessageType::composite ||
           type == MessageType::query;
}

}  // namespace

std::string requireHash(const std::string& text, const char* where) {
    auto digits = digitsOfHash(text);
    if (!digits)
        throw RequestError("bad_request",
                           std::string(where) + " must be sha256: and 64 hexadecimal digits in lower case", where);
    return *digits;
}

std::optional<std::string> digitsOfHash(std::string_view text) {
    constexpr std::string_view prefix = "sha256:";
    if (text.starts_with(prefix)) text.remove_prefix(prefix.size());
    const auto isDigit = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); };
    if (text.size() != 64 || !std::ranges::all_of(text, isDigit)) return std::nullopt;
    return std::string(text);
}

Request parseRequest(Message message, const RequestLimits& limits) {
    const json object = parseObject(message.json);
    JsonFields fields(object, "");
    if (!message.payload.empty() && !takesPayload(message.type))
        throw RequestError("bad_request", std::string(messageName(message.type)) + " takes no payload");
    Request request = readRequest(message, fields, limits);
    fields.finish();
    return request;
}

}  // namespace lumulus::service
