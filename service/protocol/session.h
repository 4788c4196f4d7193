#pragma once

#include <span>
#include <string>
#include <vector>

#include "service/protocol/message.h"
#include "service/protocol/requests.h"

namespace lumulus::service {

struct SessionPolicy {
    std::string token;    ///< that clients must give; empty: none
    std::string welcome;  ///< JSON of the reply to hello
    MessageLimits messages;
    RequestLimits requests;
};

/// A request with the id that its replies echo.
struct Incoming {
    std::uint64_t id = 0;
    Request request;
};

/// One connection as a state machine, without sockets, clocks or threads: bytes go in, replies and requests come out.
/// The first request has to be hello. A mistake in a request is answered; a mistake in the framing ends the connection.
class Session {
  public:
    /// `policy` must outlive the session.
    explicit Session(const SessionPolicy& policy);

    struct Result {
        std::vector<Message> replies;  ///< to hello, ping and bad requests
        std::vector<Incoming> requests;
        std::uint64_t refusals = 0;  ///< errors among the replies
        bool close = false;          ///< after the replies
    };
    Result receive(std::span<const std::byte> bytes);

    bool greeted() const { return greeted_; }
    const std::string& client() const { return client_; }
    /// Whether a message has begun and is not complete.
    bool midMessage() const { return reader_.midMessage(); }

  private:
    void handle(Message message, Result& result);
    void greet(std::uint64_t id, const Hello& hello, Result& result);

    const SessionPolicy& policy_;
    MessageReader reader_;
    bool greeted_ = false;
    bool closed_ = false;
    std::string client_;
};

}  // namespace lumulus::service
