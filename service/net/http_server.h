#pragma once

#include <memory>
#include <string>

#include "service/net/asio.h"
#include "service/net/hub.h"
#include "service/net/seats.h"

namespace lumulus::service {

/// Serves the page for people, /health, /ready and /metrics, and the protocol over a WebSocket at /frames.
class HttpServer {
  public:
    HttpServer(asio::io_context& io, Hub& hub);

    /// Begins to accept connections. Errors: InputError where the address is taken or cannot be used.
    void listen(const TcpAddress& address);
    /// Where it listens, as "127.0.0.1:7789"; empty where it does not.
    const std::string& address() const { return address_; }
    void close();

  private:
    asio::io_context& io_;
    Hub& hub_;
    Seats seats_, refusals_;
    std::shared_ptr<Tcp::acceptor> acceptor_;
    std::string address_;
};

}  // namespace lumulus::service
