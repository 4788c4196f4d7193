#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

#include "service/protocol/message.h"
#include "service/protocol/requests.h"
#include "service/values/request_error.h"

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
    std::uint64_t payloadBytes = 0;  ///< that it came with, and may hold still
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
    /// Takes bytes off the front of `bytes` until `most` messages are complete or all are used up.
    Result receive(std::span<const std::byte>& bytes, std::size_t most);
    Result receive(std::span<const std::byte> bytes) { return receive(bytes, std::numeric_limits<std::size_t>::max()); }

    bool greeted() const { return greeted_; }
    /// Whether the connection ended for a wrong token.
    bool wrongToken() const { return wrongToken_; }
    const std::string& client() const { return client_; }
    /// Whether a message has begun and is not complete.
    bool midMessage() const { return reader_.midMessage(); }
    /// Bytes of it that have arrived.
    std::uint64_t held() const { return reader_.held(); }
    /// Refuses the message that is not complete, whose rest cannot be told from what follows: the connection ends.
    Result refuse(const RequestError& error);

  private:
    void handle(Message message, Result& result);
    void greet(std::uint64_t id, const Hello& hello, Result& result);

    const SessionPolicy& policy_;
    MessageReader reader_;
    bool greeted_ = false;
    bool closed_ = false;
    bool wrongToken_ = false;
    std::string client_;
};

}  // namespace lumulus::service
