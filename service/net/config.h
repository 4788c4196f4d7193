#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "service/protocol/message.h"
#include "service/protocol/requests.h"

namespace lumulus::service {

/// Where a socket listens: "127.0.0.1:7788", "[::1]:7788", or nothing.
struct TcpAddress {
    std::string host;
    std::uint16_t port = 0;

    bool empty() const { return host.empty(); }
    /// Whether only programs of this machine can reach it.
    bool loopback() const;
};

/// Errors: InputError with `where` for what is no address of numbers and a port.
TcpAddress parseAddress(const std::string& text, const std::string& where);

struct Limits {
    std::uint32_t connections = 128;
    std::uint32_t queuedFrames = 8;     ///< of one connection, beyond latest-wins
    std::uint32_t streams = 16;         ///< of one connection
    std::uint32_t scenes = 3;           ///< held in memory at once
    std::uint32_t unsentFrames = 2;     ///< to one connection, before it gets no more
    double requestsPerSecond = 2000.0;  ///< of one connection, read; more wait in the socket
    double sceneMemory = 2048.0;        ///< MiB for density and for photons of one scene
    std::uint64_t photonsPerGeneration = 4'000'000;
    double generationSeconds = 30.0;  ///< one generation, one picture: longer, and the scene is dropped
    double loadSeconds = 120.0;
    double helloSeconds = 5.0;     ///< from connecting to hello
    double messageSeconds = 30.0;  ///< from the first byte of a message to its last
    double writeSeconds = 10.0;    ///< for a client to take what it was sent
    double idleSeconds = 600.0;    ///< without a message, a stream or a frame under way
    double shutdownSeconds = 5.0;  ///< for what was promised
    std::uint64_t uploadFolderBytes = std::uint64_t{8} << 30U;
    MessageLimits messages;
    RequestLimits requests;
};

/// What configs/service.toml says.
struct Config {
    TcpAddress tcp{"127.0.0.1", 7788};
    TcpAddress http{"127.0.0.1", 7789};
    std::filesystem::path unixSocket;  ///< empty: none
    unsigned unixMode = 0660;
    std::filesystem::path scenes;   ///< folder
    std::filesystem::path uploads;  ///< folder, made where it does not exist
    std::string defaultScene;       ///< name in `scenes`; empty: clients load one
    std::string quality;            ///< of the default scene: "", draft, interactive or final
    std::string device;
    std::string token;      ///< contents of the token file; empty: none
    std::string hostNames;  ///< under which browsers may reach the page, besides numbers and localhost
    Limits limits;
};

/// Reads the file; paths are relative to it. Errors: InputError for unknown keys, wrong types, values out of range, a
/// token file that cannot be read or is too short, and addresses beyond loopback without one.
Config loadConfig(const std::filesystem::path& path);

}  // namespace lumulus::service
