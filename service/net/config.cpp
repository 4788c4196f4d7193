#include "service/net/config.h"

#include <arpa/inet.h>
#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <map>

#include "base/error.h"
#include "scene/toml.h"
#include "service/net/config_reader.h"

namespace lumulus::service {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t shortestToken = 16;
constexpr double megabyte = 1024.0 * 1024.0;

std::string readToken(const fs::path& path) {
    std::ifstream file(path);
    std::string token;
    if (!std::getline(file, token))
        throw InputError("cannot read the token file", path.string(), "write a token into it, one line");
    while (!token.empty() && (token.back() == '\r' || token.back() == ' ')) token.pop_back();
    if (token.size() < shortestToken)
        throw InputError(fmt::format("the token is shorter than {} characters", shortestToken), path.string(),
                         "make one, as with: openssl rand -hex 32");
    return token;
}

/// As the XDG Base Directory Specification has it.
fs::path cacheFolder() {
    if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache != nullptr && *cache != '\0') return cache;
    if (const char* home = std::getenv("HOME"); home != nullptr && *home != '\0') return fs::path(home) / ".cache";
    return fs::temp_directory_path();
}

void readListen(ConfigReader& reader, Config& config) {
    const auto address = [&](const char* key, TcpAddress& to) {
        if (const auto text = reader.text(key))
            to = text->empty() ? TcpAddress{} : parseAddress(*text, reader.where(key));
    };
    address("listen.tcp", config.tcp);
    address("listen.http", config.http);
    if (const auto path = reader.path("listen.unix")) config.unixSocket = *path;
    if (const auto mode = reader.text("listen.unix_mode")) {
        char* end = nullptr;
        const unsigned long value = std::strtoul(mode->c_str(), &end, 8);
        if (mode->empty() || *end != '\0' || value > 0777)
            throw InputError("no permissions: " + *mode, reader.where("listen.unix_mode"),
                             "give octal digits: \"0660\"");
        config.unixMode = static_cast<unsigned>(value);
    }
    config.hostNames = reader.text("listen.host_names").value_or("");
}

void readScenes(ConfigReader& reader, Config& config) {
    config.render.scenes = reader.path("scenes.folder").value_or(reader.folder() / "scenes");
    config.render.uploads = reader.path("scenes.uploads").value_or(cacheFolder() / "lumulus" / "uploads");
    config.render.defaultScene = reader.text("scenes.default").value_or("");
    config.render.quality = reader.text("scenes.quality").value_or("");
    config.render.device = reader.text("scenes.device").value_or("");
    if (!fs::is_directory(config.render.scenes))
        throw InputError("no folder: " + config.render.scenes.string(), reader.where("scenes.folder"),
                         "give the folder of the scene files");
    if (!config.render.quality.empty() && config.render.quality != "draft" && config.render.quality != "interactive" &&
        config.render.quality != "final")
        throw InputError("no such quality: " + config.render.quality, reader.where("scenes.quality"),
                         "give draft, interactive or final");
}

void readSizes(ConfigReader& reader, Config& config) {
    RenderLimits& render = config.render.limits;
    ConnectionLimits& limits = config.limits;
    const auto megabytes = [&](const char* key, std::uint64_t& bytes) {
        double value = static_cast<double>(bytes) / megabyte;
        reader.number(key, value, 0.0, 1e7);
        bytes = static_cast<std::uint64_t>(value * megabyte);
    };
    megabytes("limits.payload_megabytes", limits.messages.payloadBytes);
    megabytes("limits.upload_megabytes", render.requests.uploadBytes);
    megabytes("limits.upload_folder_megabytes", render.uploadFolderBytes);
    megabytes("limits.upload_client_megabytes", render.uploadClientBytes);
    megabytes("limits.memory_megabytes", render.memoryBytes);
    std::uint64_t kilobytes = limits.messages.jsonBytes >> 10U;
    reader.count("limits.json_kilobytes", kilobytes, 4, 16384);
    limits.messages.jsonBytes = static_cast<std::uint32_t>(kilobytes << 10U);
}

void readLimits(ConfigReader& reader, Config& config) {
    RenderLimits& render = config.render.limits;
    ConnectionLimits& limits = config.limits;
    reader.count("limits.connections", limits.connections, 1, 4096);
    reader.count("limits.http_connections", limits.httpConnections, 1, 4096);
    reader.number("limits.token_guesses_per_second", limits.guessesPerSecond, 0.001, 1e6);
    reader.count("limits.queued_frames", render.queuedFrames, 1, 1024);
    reader.count("limits.streams", render.streams, 1, 1024);
    reader.count("limits.scenes", render.scenes, 1, 64);
    reader.count("limits.own_lights", render.ownLights, 0, 256);
    reader.count("limits.unsent_frames", render.unsentFrames, 1, 64);
    reader.count("limits.views", render.requests.views, 1, 256);
    reader.count("limits.pixels", render.requests.pixels, 1, 1U << 25U);
    reader.count("limits.photons_per_generation", render.photonsPerGeneration, 1, 4'026'531'840U);
    reader.number("limits.requests_per_second", limits.requestsPerSecond, 1.0, 1e6);
    reader.number("limits.scene_megabytes", render.sceneMemory, 1.0, 1e6);
    reader.number("limits.generation_seconds", render.generationSeconds, 0.1, 1e5);
    reader.number("limits.load_seconds", render.loadSeconds, 0.1, 1e5);
    reader.number("limits.reload_seconds", render.reloadSeconds, 0.0, 1e6);
    reader.number("limits.hello_seconds", limits.helloSeconds, 0.1, 1e5);
    reader.number("limits.message_seconds", limits.messageSeconds, 0.1, 1e5);
    reader.number("limits.write_seconds", limits.writeSeconds, 0.1, 1e5);
    double kilobytes = limits.writeBytesPerSecond / 1024.0;
    reader.number("limits.write_kilobytes_per_second", kilobytes, 0.0, 1e6);
    limits.writeBytesPerSecond = kilobytes * 1024.0;
    reader.number("limits.upload_hours", render.uploadHours, 0.001, 1e6);
    reader.number("limits.heartbeat_seconds", render.heartbeatSeconds, 0.1, 1e5);
    reader.number("limits.idle_seconds", limits.idleSeconds, 0.1, 1e7);
    reader.number("limits.shutdown_seconds", render.shutdownSeconds, 0.0, 1e5);
}

void requireTokenBeyondLoopback(const Config& config, const std::string& where) {
    for (const TcpAddress* address : {&config.tcp, &config.http})
        if (!address->empty() && !address->loopback() && config.token.empty())
            throw InputError("others could reach " + address->host + ", and there is no token", where,
                             "give security.token_file, or listen on 127.0.0.1");
}

}  // namespace

bool TcpAddress::loopback() const {
    return host == "::1" || host.starts_with("127.");
}

TcpAddress parseAddress(const std::string& text, const std::string& where) {
    const std::size_t colon = text.rfind(':');
    TcpAddress address;
    if (colon != std::string::npos) {
        address.host = text.substr(0, colon);
        if (address.host.starts_with('[') && address.host.ends_with(']'))
            address.host = address.host.substr(1, address.host.size() - 2);
        const std::string port = text.substr(colon + 1);
        const bool digits =
            !port.empty() && port.size() <= 5 && port.find_first_not_of("0123456789") == std::string::npos;
        const int number = digits ? std::stoi(port) : 65536;
        in6_addr parsed{};
        const bool known = ::inet_pton(AF_INET, address.host.c_str(), &parsed) == 1 ||
                           ::inet_pton(AF_INET6, address.host.c_str(), &parsed) == 1;
        if (known && number <= 65535) {
            address.port = static_cast<std::uint16_t>(number);
            return address;
        }
    }
    throw InputError("no address: " + text, where, "give numbers and a port, as 127.0.0.1:7788 or [::1]:7788");
}

Config loadConfig(const fs::path& path) {
    ConfigReader reader(path);
    Config config;
    readListen(reader, config);
    readScenes(reader, config);
    if (const auto token = reader.path("security.token_file")) config.token = readToken(*token);
    config.render.sharedLight = reader.boolean("security.shared_light").value_or(false);
    readSizes(reader, config);
    readLimits(reader, config);
    reader.finish();
    requireTokenBeyondLoopback(config, path.string());
    if (config.tcp.empty() && config.http.empty() && config.unixSocket.empty())
        throw InputError("nothing to listen on", path.string(), "give listen.tcp, listen.unix or listen.http");
    return config;
}

}  // namespace lumulus::service
