#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "service/protocol/message.h"
#include "service/render/render_config.h"

namespace lumulus::service {

/// The address on which a socket listens, as "127.0.0.1:7788" or "[::1]:7788"; or none.
struct TcpAddress {
    std::string host;
    std::uint16_t port = 0;

    bool empty() const { return host.empty(); }
    /// Whether only programs of this machine can reach it.
    bool loopback() const;
};

/// Reads an address. Errors: InputError with `where` for text that is not an address of numbers and a port.
TcpAddress parseAddress(const std::string& text, const std::string& where);

/// Limits of connections.
struct ConnectionLimits {
    std::uint32_t connections = 128;      ///< to the frame ports
    std::uint32_t httpConnections = 128;  ///< to the HTTP port, WebSockets among them
    double guessesPerSecond = 1.0;        ///< of the token, wrong, from one address
    double requestsPerSecond = 2000.0;    ///< of one connection, read; more wait in the socket
    double helloSeconds = 5.0;            ///< from connecting to hello
    double messageSeconds = 30.0;         ///< from the first byte of a message to its last
    double writeSeconds = 10.0;           ///< a period in which a client has to take so much as the next line says
    double writeBytesPerSecond = 16384.0;
    double idleSeconds = 600.0;  ///< without a message, a stream or a frame under way
    MessageLimits messages;
};

/// The configuration of the service, as in configs/service.toml.
struct Config {
    TcpAddress tcp{"127.0.0.1", 7788};
    TcpAddress http{"127.0.0.1", 7789};
    std::filesystem::path unixSocket;  ///< empty: none
    unsigned unixMode = 0660;
    std::string token;      ///< contents of the token file; empty: none
    std::string hostNames;  ///< under which browsers may reach the page, besides numbers and localhost
    ConnectionLimits limits;
    RenderConfig render;
};

/// Reads the file; paths are relative to it. Errors: InputError for unknown keys, wrong types, values out of range, a
/// token file that cannot be read or is too short, and addresses beyond loopback without one.
Config loadConfig(const std::filesystem::path& path);

}  // namespace lumulus::service
