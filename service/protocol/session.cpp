#include "service/protocol/session.h"

#include "base/text.h"
#include "service/protocol/error_reply.h"
#include "service/protocol/json_fields.h"
#include "service/values/sha256.h"

namespace lumulus::service {

namespace {

/// Strangers get little room.
constexpr MessageLimits strangerLimits{4096, 0};

}  // namespace

Session::Session(const SessionPolicy& policy) : policy_(policy), reader_(strangerLimits) {}

Session::Result Session::receive(std::span<const std::byte>& bytes, std::size_t most) {
    Result result;
    try {
        for (std::size_t count = 0; count < most && !closed_; ++count) {
            auto message = reader_.read(bytes);
            if (!message) break;
            handle(std::move(*message), result);
        }
    } catch (const FramingError& e) {
        result.replies.push_back(errorReply(e.id, e.code, e.what()));
        ++result.refusals;
        closed_ = true;
    }
    if (closed_) bytes = {};
    result.close = closed_;
    return result;
}

Session::Result Session::refuse(const RequestError& error) {
    Result result;
    result.replies.push_back(errorReply(reader_.id(), error.code, error.what(), error.where));
    result.refusals = 1;
    result.close = closed_ = true;
    return result;
}

void Session::handle(Message message, Result& result) {
    const std::uint64_t id = message.id, payloadBytes = message.payload.size();
    try {
        if (id == 0) throw RequestError("bad_request", "an id must not be 0");
        Request request = parseRequest(std::move(message), policy_.requests);
        if (const auto* hello = std::get_if<Hello>(&request)) {
            greet(id, *hello, result);
        } else if (!greeted_) {
            throw RequestError("unauthorized", "say hello first");
        } else if (std::holds_alternative<Ping>(request)) {
            result.replies.push_back({replyTo(MessageType::ping), id, "{}", {}});
        } else {
            result.requests.push_back({id, payloadBytes, std::move(request)});
        }
    } catch (const RequestError& e) {
        result.replies.push_back(errorReply(id, e.code, e.what(), e.where));
        ++result.refusals;
        closed_ = closed_ || !greeted_;
    }
}

void Session::greet(std::uint64_t id, const Hello& hello, Result& result) {
    if (greeted_) throw RequestError("bad_request", "hello was said before");
    wrongToken_ = !policy_.token.empty() && !equalSecrets(hello.token, policy_.token);
    if (wrongToken_) throw RequestError("unauthorized", "the token is not the server's", "token");
    greeted_ = true;
    client_ = shortened(oneLine(hello.client), 100);
    reader_.setLimits(policy_.messages);
    result.replies.push_back({replyTo(MessageType::hello), id, policy_.welcome, {}});
}

}  // namespace lumulus::service
