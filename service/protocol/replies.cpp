#include "service/protocol/replies.h"

#include <cmath>
#include <span>

#include "base/version.h"
#include "scene/aerosol.h"
#include "service/protocol/error_reply.h"

namespace lumulus::service {

using nlohmann::json;

namespace {

json listOf(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

json bodyOf(const CloudDescription& cloud) {
    json body{{"name", cloud.name}, {"extinction", cloud.extinction}};
    if (cloud.asymmetry) body["g"] = *cloud.asymmetry;
    return body;
}

json sunOf(const glm::dvec3& directionTo, const glm::dvec3& irradiance) {
    return {{"direction_to", listOf(directionTo)}, {"irradiance", listOf(irradiance)}};
}

json bodyOf(const scene::FogMedium& medium) {
    static constexpr const char* kinds[] = {"homogeneous", "exponential", "sphere", "ellipsoid", "box"};
    json body{{"kind", kinds[static_cast<std::size_t>(medium.kind)]},
              {"scattering", listOf(medium.scattering)},
              {"absorption", listOf(medium.absorption)},
              {"g", medium.g}};
    if (const auto visibility = scene::visibilityOf(medium.scattering + medium.absorption))
        body["visibility"] = *visibility;
    if (medium.kind == scene::MediumKind::exponential) body["falloff"] = medium.falloff;
    if (std::isfinite(medium.bottom)) body["bottom"] = medium.bottom;
    if (std::isfinite(medium.top)) body["top"] = medium.top;
    return body;
}

json mediaOf(const std::vector<scene::FogMedium>& media) {
    json list = json::array();
    for (const scene::FogMedium& medium : media) list.push_back(bodyOf(medium));
    return list;
}

json originalOf(const SceneDescription& scene) {
    json clouds = json::array();
    for (const CloudDescription& cloud : scene.originalClouds) clouds.push_back(bodyOf(cloud));
    return {{"sun", sunOf(scene.originalSun.directionTo, scene.originalSun.irradiance)},
            {"clouds", std::move(clouds)},
            {"media", mediaOf(scene.originalMedia)}};
}

json bodyOf(const SceneDescription& scene) {
    json body{{"name", scene.name},
              {"width", scene.image.width},
              {"height", scene.image.height},
              {"exposure", scene.image.exposure},
              {"sun", sunOf(scene.light.sunDirection, scene.light.sunIrradiance)},
              {"seed", scene.seed},
              {"generations", scene.generations},
              {"collectors", scene.collectors},
              {"device", scene.device},
              {"warnings", scene.warnings},
              {"media", mediaOf(scene.light.media)},
              {"center", listOf(scene.centre)},
              {"radius", scene.radius}};
    if (scene.light.extinction) body["extinction"] = *scene.light.extinction;
    if (scene.asymmetry) body["g"] = *scene.asymmetry;
    body["original"] = originalOf(scene);
    return body;
}

json bodyOf(const SceneState& scene) {
    return {{"scene", scene.name},
            {"generations", scene.photons.generations},
            {"current_generations", scene.photons.current},
            {"generations_wanted", scene.generationsWanted},
            {"photons", scene.photons.photons()},
            {"trace_milliseconds", scene.traceMilliseconds},
            {"sun", sunOf(scene.light.sunDirection, scene.light.sunIrradiance)},
            {"extinction", scene.light.extinction ? json(*scene.light.extinction) : json()},
            {"media", mediaOf(scene.light.media)},
            {"own", scene.own},
            {"clients", scene.clients}};
}

json bodyOf(const SceneShown& shown) {
    return {{"scene", shown.name},
            {"photons", shown.photons.photons()},
            {"generations", shown.photons.generations},
            {"current_generations", shown.photons.current},
            {"first_generation", shown.photons.firstGeneration},
            {"photons_each", shown.photons.photonsEach},
            {"repeat", shown.repeat},
            {"oldest_seconds", shown.oldestSeconds},
            {"noise", shown.noise ? json(*shown.noise) : json()},
            {"bias", shown.bias ? json{{"value", shown.bias->value}, {"sigma", shown.bias->sigma}} : json()}};
}

json millisecondsOf(const FrameResult& result, const FrameTimes& times) {
    json passes = json::object();
    double trace = 0.0;
    for (const PassTime& pass : result.passes) {
        passes[pass.name] = passes.value(pass.name, 0.0) + pass.milliseconds;
        if (pass.stage == Stage::photons) trace += pass.milliseconds;
    }
    return {{"waited", result.waitedMilliseconds},
            {"trace", trace},
            {"draw", result.drawMilliseconds},
            {"encode", times.encode},
            {"total", times.total},
            {"passes", std::move(passes)}};
}

Message messageOf(std::uint64_t id, const SceneDescription& scene) {
    return {replyTo(MessageType::loadScene), id, bodyOf(scene).dump(), {}};
}

Message messageOf(std::uint64_t id, const StreamStopped& stopped) {
    return {replyTo(MessageType::stopStream), id, json{{"found", stopped.found}}.dump(), {}};
}

Message messageOf(std::uint64_t id, const FrameCancelled& cancelled) {
    return {replyTo(MessageType::cancel), id, json{{"found", cancelled.found}}.dump(), {}};
}

Message messageOf(std::uint64_t id, const LightChanged&) {
    return {replyTo(MessageType::change), id, "{}", {}};
}

Message messageOf(std::uint64_t id, const DensityChanged& changed) {
    json clouds = json::array();
    for (const CloudShown& cloud : changed.clouds) {
        json shown{{"name", cloud.name}};
        if (!cloud.vdb.empty()) shown["vdb"] = "sha256:" + cloud.vdb;
        if (cloud.file) shown["file"] = *cloud.file;
        clouds.push_back(std::move(shown));
    }
    const json body{{"scene", bodyOf(changed.scene)},
                    {"clouds", std::move(clouds)},
                    {"carried", changed.carried},
                    {"generations", changed.photons.generations},
                    {"current_generations", changed.photons.current}};
    return {replyTo(MessageType::change), id, body.dump(), {}};
}

Message messageOf(std::uint64_t id, const QueryAnswer& answer) {
    constexpr const char* names[] = {"segments", "sun", "ground_shadow", "ambient"};
    const json body{{"product", names[static_cast<std::size_t>(answer.product)]},
                    {"width", answer.width},
                    {"height", answer.height},
                    {"channels", answer.channels},
                    {"type", "float"}};
    const auto bytes = std::as_bytes(std::span(answer.values));
    return {replyTo(MessageType::query), id, body.dump(), {bytes.begin(), bytes.end()}};
}

Message messageOf(std::uint64_t id, const Failure& failure) {
    return errorReply(id, failure.code, failure.text, failure.where);
}

}  // namespace

std::string welcomeText(const Welcome& welcome) {
    const json body{{"version", protocolVersion},
                    {"software", std::string("lumulus ") + version},
                    {"scene", welcome.scene},
                    {"quality", welcome.quality},
                    {"shared_light", welcome.sharedLight},
                    {"limits",
                     {{"json_bytes", welcome.messages.jsonBytes},
                      {"payload_bytes", welcome.messages.payloadBytes},
                      {"pixels", welcome.requests.pixels},
                      {"views", welcome.requests.views},
                      {"upload_bytes", welcome.requests.uploadBytes},
                      {"streams", welcome.streams},
                      {"queued_frames", welcome.queuedFrames}}}};
    return body.dump();
}

Message encodeReply(std::uint64_t id, const Reply& reply) {
    return std::visit([id](const auto& result) { return messageOf(id, result); }, reply);
}

Message statisticsReply(std::uint64_t id, const std::vector<std::pair<std::string_view, std::int64_t>>& counters,
                        const std::optional<SceneState>& scene, const std::optional<LoadState>& loading) {
    json body = json::object();
    for (const auto& [name, value] : counters) body[std::string(name)] = value;
    if (scene) body["scene"] = bodyOf(*scene);
    if (loading) body["loading"] = {{"step", loading->step}, {"seconds", loading->seconds}};
    return {replyTo(MessageType::statistics), id, body.dump(), {}};
}

Message scenesReply(std::uint64_t id, const std::vector<std::string>& names) {
    return {replyTo(MessageType::listScenes), id, json{{"scenes", names}}.dump(), {}};
}

Message uploadReply(std::uint64_t id, std::uint64_t received, bool complete) {
    return {replyTo(MessageType::upload), id, json{{"received", received}, {"complete", complete}}.dump(), {}};
}

Message uploadsReply(std::uint64_t id, const std::vector<StoredUpload>& uploads, std::uint64_t mostBytes) {
    json list = json::array();
    std::uint64_t bytes = 0;
    for (const StoredUpload& upload : uploads) {
        list.push_back({{"hash", "sha256:" + upload.hash},
                        {"bytes", upload.bytes},
                        {"seconds_left", std::floor(upload.secondsLeft)}});
        bytes += upload.bytes;
    }
    const json body{{"uploads", std::move(list)}, {"bytes", bytes}, {"most_bytes", mostBytes}};
    return {replyTo(MessageType::listUploads), id, body.dump(), {}};
}

Message uploadDeletedReply(std::uint64_t id, bool found) {
    return {replyTo(MessageType::deleteUpload), id, json{{"found", found}}.dump(), {}};
}

bool budgetMet(const Budget& budget, const FrameResult& result, double totalMilliseconds) {
    return (!budget.milliseconds || totalMilliseconds <= *budget.milliseconds) &&
           (!budget.photons || result.shown.photons.photons() >= *budget.photons);
}

Message frameReply(const FrameMark& mark, const FrameRequest& request, const FrameResult& result,
                   EncodedPictures pictures, const FrameTimes& times) {
    json body = bodyOf(result.shown);
    body["channel"] = request.channel;
    body["number"] = mark.number;
    body["time"] = request.time;
    body["encoding"] = encodingName(request.format.encoding);
    for (std::size_t i = 0; i < result.views.size(); ++i) {
        pictures.views[i]["drawn_width"] = result.views[i].drawnWidth;
        pictures.views[i]["drawn_height"] = result.views[i].drawnHeight;
    }
    body["views"] = std::move(pictures.views);
    body["reduction"] = result.reduction;
    body["sun_reduction"] = result.sunReduction;
    body["budget_met"] = budgetMet(request.budget, result, times.total);
    body["hash"] = std::move(pictures.hash);
    body["milliseconds"] = millisecondsOf(result, times);
    const auto type = replyTo(mark.stream ? MessageType::startStream : MessageType::frame);
    return {type, mark.id, body.dump(), std::move(pictures.payload)};
}

Message compositeReply(std::uint64_t id, const Composite& request, const CompositeResult& result,
                       EncodedPictures pictures, const FrameTimes& times) {
    json body{{"scene", result.scene}, {"encoding", encodingName(request.format.encoding)}};
    body["views"] = std::move(pictures.views);
    body["hash"] = std::move(pictures.hash);
    body["milliseconds"] = {{"waited", result.waitedMilliseconds}, {"total", times.total}};
    return {replyTo(MessageType::composite), id, body.dump(), std::move(pictures.payload)};
}

}  // namespace lumulus::service
