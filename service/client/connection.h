#pragma once

#include <chrono>
#include <string>

#include "service/protocol/message.h"

namespace lumulus {

/// A socket that sends and takes whole messages. Errors: ClientError `connection`.
class ClientConnection {
  public:
    ClientConnection(const std::string& address, double timeout);
    ClientConnection(const ClientConnection&) = delete;
    ClientConnection& operator=(const ClientConnection&) = delete;
    ~ClientConnection();

    void send(const service::Message& message);
    service::Message receive();

  private:
    void wait(short events, std::chrono::steady_clock::time_point until) const;
    void sendAll(std::span<const std::byte> bytes);

    int socket_ = -1;
    std::chrono::duration<double> timeout_;
    service::MessageReader reader_;
    std::vector<std::byte> buffer_;
    std::span<const std::byte> unread_;
};

}  // namespace lumulus
