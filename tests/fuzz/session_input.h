#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>

#include "fuzz/promise.h"
#include "service/protocol/session.h"

namespace lumulus::service::test {

/// Feeds bytes to a session, whole and in pieces of a size that the first byte chooses, and to the decoder of headers.
/// Throws std::logic_error where what comes out breaks a promise: replies that are no JSON, requests without a hello,
/// anything after the end, and results that depend on the pieces.
inline void feedSession(std::span<const std::byte> input) {
    using lumulus::test::promise;
    if (input.empty()) return;
    const SessionPolicy policy{"secret", "{}", {1U << 14U, 1U << 16U}, {1U << 20U, 4, 1U << 20U}};
    const std::size_t piece = 1 + std::to_integer<std::size_t>(input[0]);
    const std::span<const std::byte> bytes = input.subspan(1);

    Session whole(policy), pieces(policy);
    const Session::Result atOnce = whole.receive(bytes);
    std::size_t replies = 0, requests = 0;
    bool closed = false;
    for (std::size_t at = 0; at < bytes.size(); at += piece) {
        const Session::Result some = pieces.receive(bytes.subspan(at, std::min(piece, bytes.size() - at)));
        promise(!closed || (some.replies.empty() && some.requests.empty()), "something came after the end");
        closed = closed || some.close;
        replies += some.replies.size();
        requests += some.requests.size();
    }
    promise(replies == atOnce.replies.size() && requests == atOnce.requests.size() && closed == atOnce.close,
            "pieces make a difference");
    promise(whole.greeted() || atOnce.requests.empty(), "a request came without a hello");
    for (const Message& reply : atOnce.replies) promise(nlohmann::json::accept(reply.json), "a reply is no JSON");
    if (bytes.size() >= headerBytes) {
        try {
            const auto first = bytes.first<headerBytes>();
            const auto again = encodeHeader(decodeHeader(first));
            promise(std::equal(first.begin(), first.end(), again.begin()), "a header does not read back");
        } catch (const FramingError&) {
            return;  // refused, as it may be
        }
    }
}

}  // namespace lumulus::service::test

namespace lumulus::test {

inline void feed(std::span<const std::byte> input) {
    service::test::feedSession(input);
}

}  // namespace lumulus::test
