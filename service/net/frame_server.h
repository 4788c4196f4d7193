#pragma once

#include <memory>
#include <string>
#include <vector>

#include "service/net/asio.h"
#include "service/net/hub.h"

namespace lumulus::service {

/// Speaks the protocol over TCP and Unix sockets.
class FrameServer {
  public:
    FrameServer(asio::io_context& io, Hub& hub);

    /// Begin to accept. Errors: InputError where the address or the path is taken or not to be had.
    void listenTcp(const TcpAddress& address);
    /// A socket that a killed server left is replaced; one that a server answers on is not.
    void listenUnix(const std::filesystem::path& path, unsigned mode);
    /// "127.0.0.1:7788", "unix:/run/…"
    const std::vector<std::string>& addresses() const { return addresses_; }
    /// Stops to accept, and removes the Unix socket.
    void close();

  private:
    asio::io_context& io_;
    Hub& hub_;
    std::vector<std::shared_ptr<Tcp::acceptor>> tcp_;
    std::vector<std::shared_ptr<asio::local::stream_protocol::acceptor>> local_;
    std::vector<std::string> addresses_;
    std::filesystem::path socketPath_;
};

/// A listening socket. Errors: InputError.
Tcp::acceptor makeAcceptor(asio::io_context& io, const TcpAddress& address);

/// "127.0.0.1:7788"
std::string addressText(const Tcp::endpoint& endpoint);

}  // namespace lumulus::service
