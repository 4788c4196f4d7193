#include <half.h>

#include <cstring>
#include <deque>
#include <fstream>
#include <nlohmann/json.hpp>

#include "service/client/connection.h"
#include "service/client/lumulus_client.h"
#include "service/values/sha256.h"

namespace lumulus {

using nlohmann::json;
using service::Message;
using service::MessageType;

namespace {

constexpr std::size_t chunkBytes = 1UL << 20U;

json withFields(json object, const std::map<std::string, std::string>& fields) {
    for (const auto& [name, text] : fields) {
        object[name] = json::parse(text, nullptr, false);
        if (object[name].is_discarded()) throw ClientError("bad_request", name + " is no JSON: " + text);
    }
    return object;
}

json queryJson(const FrameQuery& query) {
    json object = json::object();
    json camera = json::object();
    const auto set = [](json& to, const char* name, const auto& value) {
        if (value) to[name] = *value;
    };
    set(object, "width", query.width);
    set(object, "height", query.height);
    set(object, "tile", query.tile);
    set(camera, "position", query.position);
    set(camera, "target", query.target);
    set(camera, "up", query.up);
    set(camera, "orientation", query.orientation);
    set(camera, "vertical_fov", query.verticalFov);
    set(camera, "frustum", query.frustum);
    if (!camera.empty()) object["camera"] = camera;
    if (query.sun) object["sun"] = {{"azimuth", (*query.sun)[0]}, {"elevation", (*query.sun)[1]}};
    if (query.milliseconds) object["budget"] = {{"milliseconds", *query.milliseconds}};
    if (query.photons) object["budget"] = {{"photons", *query.photons}};
    object["encoding"] = query.encoding;
    object["products"] = query.products;
    return withFields(std::move(object), query.more);
}

FrameView readView(const json& from) {
    FrameView view;
    view.width = from.at("width");
    view.height = from.at("height");
    if (from.contains("products")) {
        for (const json& product : from.at("products"))
            view.products.push_back({product.at("name"), product.at("channels"), product.at("type"),
                                     product.at("offset"), product.at("bytes")});
    } else {
        view.fileType = from.at("type");
        view.offset = from.at("offset");
        view.bytes = from.at("bytes");
    }
    return view;
}

Frame readFrame(Message message) {
    Frame frame;
    try {
        const json body = json::parse(message.json);
        frame.photons = body.at("photons");
        frame.firstGeneration = body.at("first_generation");
        frame.generations = body.at("generations");
        frame.budgetMet = body.at("budget_met");
        frame.reduction = body.at("reduction");
        frame.totalMilliseconds = body.at("milliseconds").at("total");
        for (const json& view : body.at("views")) frame.views.push_back(readView(view));
    } catch (const json::exception& e) {
        throw ClientError("connection", std::string("the server's reply makes no sense: ") + e.what());
    }
    frame.id = message.id;
    frame.json = std::move(message.json);
    frame.payload = std::move(message.payload);
    return frame;
}

}  // namespace

std::vector<float> Frame::values(std::size_t view, const std::string& product) const {
    for (const FrameProduct& p : views.at(view).products) {
        if (p.name != product) continue;
        const std::size_t size = p.type == "half" ? sizeof(Imath::half) : sizeof(float);
        if (p.offset > payload.size() || p.bytes > payload.size() - p.offset)
            throw ClientError("connection", "the server's reply is too short");
        std::vector<float> result(p.bytes / size);
        const std::byte* from = payload.data() + p.offset;
        if (size == sizeof(float)) {
            std::memcpy(result.data(), from, result.size() * size);
            return result;
        }
        for (std::size_t i = 0; i < result.size(); ++i) {
            Imath::half value;
            std::memcpy(&value, from + i * size, size);
            result[i] = value;
        }
        return result;
    }
    throw ClientError("bad_request", "the view has no product " + product);
}

struct Client::State {
    State(const std::string& address, double timeout) : connection(address, timeout) {}

    ClientConnection connection;
    std::uint64_t nextId = 1;
    std::deque<Message> early;  // replies to others than the one that is waited for
    std::string welcome;

    std::uint64_t send(MessageType type, const json& object, std::vector<std::byte> payload = {},
                       std::optional<std::uint64_t> id = std::nullopt) {
        const std::uint64_t used = id ? *id : nextId++;
        connection.send({type, used, object.dump(), std::move(payload)});
        return used;
    }

    Message wait(std::uint64_t id) {
        for (auto it = early.begin(); it != early.end(); ++it) {
            if (it->id != id) continue;
            Message found = std::move(*it);
            early.erase(it);
            return checked(std::move(found));
        }
        while (true) {
            Message message = connection.receive();
            if (message.id == id || (message.type == MessageType::error && message.id == 0))
                return checked(std::move(message));
            early.push_back(std::move(message));
        }
    }

    Message ask(MessageType type, const json& object, std::vector<std::byte> payload = {}) {
        return wait(send(type, object, std::move(payload)));
    }

    static Message checked(Message message) {
        if (message.type != MessageType::error) return message;
        const json body = json::parse(message.json, nullptr, false);
        if (!body.is_object()) throw ClientError("connection", "the server's reply makes no sense");
        throw ClientError(body.value("code", "unknown"), body.value("message", ""));
    }
};

Client::Client(const std::string& address, const std::string& token, double timeout)
    : state_(std::make_unique<State>(address, timeout)) {
    const json hello{{"version", service::protocolVersion}, {"token", token}, {"client", "lumulus_client"}};
    state_->welcome = state_->ask(MessageType::hello, hello).json;
}
Client::Client(Client&&) noexcept = default;
Client& Client::operator=(Client&&) noexcept = default;
Client::~Client() = default;

const std::string& Client::welcome() const {
    return state_->welcome;
}

std::string Client::loadScene(const std::string& name, const std::map<std::string, std::string>& fields) {
    return state_->ask(MessageType::loadScene, withFields({{"name", name}}, fields)).json;
}

std::string Client::loadSceneText(const std::string& toml, const std::map<std::string, std::string>& fields) {
    const auto bytes = std::as_bytes(std::span(toml));
    return state_->ask(MessageType::loadScene, withFields(json::object(), fields), {bytes.begin(), bytes.end()}).json;
}

std::string Client::upload(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::vector<std::byte> bytes(chunkBytes);
    const auto next = [&] {
        file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(chunkBytes));
        return std::span(bytes).first(static_cast<std::size_t>(file.gcount()));
    };
    service::Sha256 sha;
    std::uint64_t size = 0;
    for (auto chunk = next(); !chunk.empty(); chunk = next()) {
        sha.update(chunk);
        size += chunk.size();
    }
    if (size == 0) throw ClientError("bad_request", path + " cannot be read, or is empty");
    const std::string hash = "sha256:" + sha.hex();
    file.clear();
    file.seekg(0);
    for (std::uint64_t offset = 0; offset < size;) {
        const auto chunk = next();
        const Message reply = state_->ask(MessageType::upload, {{"hash", hash}, {"size", size}, {"offset", offset}},
                                          {chunk.begin(), chunk.end()});
        if (json::parse(reply.json).value("complete", false)) break;
        offset += chunk.size();
    }
    return hash;
}

Frame Client::frame(const FrameQuery& query) {
    return readFrame(state_->ask(MessageType::frame, queryJson(query)));
}

std::uint64_t Client::startStream(const FrameQuery& query, std::optional<std::uint64_t> id) {
    return state_->send(MessageType::startStream, queryJson(query), {}, id);
}

Frame Client::nextFrame(std::uint64_t stream) {
    return readFrame(state_->wait(stream));
}

void Client::stopStream(std::uint64_t stream) {
    state_->ask(MessageType::stopStream, {{"stream", stream}});
    std::erase_if(state_->early, [&](const Message& message) { return message.id == stream; });
}

std::pair<std::string, std::vector<std::byte>> Client::request(std::uint16_t type, const std::string& text,
                                                               const std::vector<std::byte>& payload) {
    const json object = json::parse(text, nullptr, false);
    if (!object.is_object()) throw ClientError("bad_request", "a request is a JSON object");
    Message reply = state_->ask(static_cast<MessageType>(type), object, payload);
    return {std::move(reply.json), std::move(reply.payload)};
}

}  // namespace lumulus
