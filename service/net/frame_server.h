#pragma once

#include <memory>
#include <string>
#include <vector>

#include "service/net/asio.h"
#include "service/net/hub.h"
#include "service/net/seats.h"

namespace lumulus::service {

/// Speaks the protocol over TCP and Unix sockets.
class FrameServer {
  public:
    FrameServer(asio::io_context& io, Hub& hub);

    /// Begins to accept connections. Errors: InputError where the address or the path is taken or cannot be used.
    void listenTcp(const TcpAddress& address);
    /// The same on a Unix socket. One that a killed server left is replaced; one on which a server answers is an error.
    void listenUnix(const std::filesystem::path& path, unsigned mode);
    /// Where it listens, as "127.0.0.1:7788" or "unix:/run/…".
    const std::vector<std::string>& addresses() const { return addresses_; }
    /// Stops accepting connections, and removes the Unix socket.
    void close();

  private:
    void take(asio::generic::stream_protocol::socket socket, const std::string& from);

    asio::io_context& io_;
    Hub& hub_;
    Seats seats_, refusals_;
    std::vector<std::shared_ptr<Tcp::acceptor>> tcp_;
    std::vector<std::shared_ptr<asio::local::stream_protocol::acceptor>> local_;
    std::vector<std::string> addresses_;
    std::filesystem::path socketPath_;
};

/// Makes a listening socket. Errors: InputError.
Tcp::acceptor makeAcceptor(asio::io_context& io, const TcpAddress& address);

/// An address as text: "127.0.0.1:7788".
std::string addressText(const Tcp::endpoint& endpoint);

}  // namespace lumulus::service
