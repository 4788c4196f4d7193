// A connection as a state machine: hello first, errors answered, broken framing ends it.
#include "service/protocol/session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "support/service_messages.h"

namespace lumulus::service {
namespace {

using nlohmann::json;
using test::encoded;
using test::request;

class SessionTest : public testing::Test {
  protected:
    SessionPolicy policy{"secret", R"({"software":"test"})", {}, {}};
    Session session{policy};

    Session::Result send(const Message& message) { return session.receive(encoded(message)); }
    Session::Result hello() { return send(request(MessageType::hello, R"({"version":1,"token":"secret"})")); }
};

std::string codeOf(const Session::Result& result) {
    if (result.replies.size() != 1 || result.replies[0].type != MessageType::error) return "";
    return json::parse(result.replies[0].json).at("code");
}

TEST_F(SessionTest, HelloOpensTheDoor) {
    const auto welcome = hello();
    ASSERT_EQ(welcome.replies.size(), 1U);
    EXPECT_EQ(welcome.replies[0], (Message{replyTo(MessageType::hello), 7, policy.welcome, {}}));
    EXPECT_TRUE(session.greeted());
    const auto pong = send(request(MessageType::ping, ""));
    ASSERT_EQ(pong.replies.size(), 1U);
    EXPECT_EQ(pong.replies[0].type, replyTo(MessageType::ping));
    const auto frame = send(request(MessageType::frame, "{}"));
    ASSERT_EQ(frame.requests.size(), 1U);
    EXPECT_EQ(frame.requests[0].id, 7U);
    EXPECT_TRUE(std::holds_alternative<FrameRequest>(frame.requests[0].request));
    EXPECT_EQ(codeOf(hello()), "bad_request");
}

TEST_F(SessionTest, AnIdIsNotZero) {
    hello();
    Message ping = request(MessageType::ping, "");
    ping.id = 0;
    const auto result = send(ping);
    EXPECT_EQ(codeOf(result), "bad_request");
    EXPECT_FALSE(result.close);
}

TEST_F(SessionTest, NothingButHelloComesFirst) {
    for (const Message& message : test::validMessages()) {
        if (message.type == MessageType::hello) continue;
        Session stranger(policy);
        const auto result = stranger.receive(encoded(message));
        EXPECT_TRUE(result.close) << message.json;
        EXPECT_TRUE(result.requests.empty());
        // a payload is refused with the header, before it is read
        EXPECT_EQ(codeOf(result), message.payload.empty() ? "unauthorized" : "too_large");
    }
}

TEST_F(SessionTest, WrongTokensAreRefusedEveryTime) {
    for (int i = 0; i < 1000; ++i) {
        Session stranger(policy);
        const std::string token = i == 0 ? "" : "secret" + std::to_string(i);
        const auto result = stranger.receive(encoded(request(MessageType::hello, R"({"token":")" + token + R"("})")));
        ASSERT_EQ(codeOf(result), "unauthorized");
        ASSERT_TRUE(result.close);
        ASSERT_FALSE(stranger.greeted());
        ASSERT_TRUE(stranger.wrongToken());
        ASSERT_TRUE(stranger.receive(encoded(request(MessageType::ping, ""))).replies.empty());
    }
}

TEST_F(SessionTest, AnotherVersionIsRefused) {
    EXPECT_EQ(codeOf(send(request(MessageType::hello, R"({"version":2,"token":"secret"})"))), "unsupported_version");
}

TEST_F(SessionTest, ABadRequestIsAnsweredAndTheNextOneHeard) {
    hello();
    EXPECT_EQ(codeOf(send(request(MessageType::frame, R"({"width":-1})"))), "bad_request");
    EXPECT_EQ(codeOf(send(request(static_cast<MessageType>(99), "{}"))), "unknown_type");
    const auto frame = send(request(MessageType::frame, "{}"));
    EXPECT_EQ(frame.requests.size(), 1U);
    EXPECT_FALSE(frame.close);
}

TEST_F(SessionTest, BrokenFramingEndsIt) {
    hello();
    auto bytes = encoded(request(MessageType::ping, ""));
    bytes[0] = std::byte{0};
    EXPECT_EQ(codeOf(session.receive(bytes)), "bad_message");
    EXPECT_TRUE(session.receive(encoded(request(MessageType::ping, ""))).close);
}

TEST_F(SessionTest, AFewMessagesAtATime) {
    hello();
    std::vector<std::byte> bytes;
    for (int i = 0; i < 40; ++i) {
        const auto ping = encoded(request(MessageType::ping, ""));
        bytes.insert(bytes.end(), ping.begin(), ping.end());
    }
    std::span<const std::byte> rest = bytes;
    EXPECT_EQ(session.receive(rest, 16).replies.size(), 16U);
    EXPECT_EQ(rest.size(), bytes.size() - 16 * headerBytes);
    EXPECT_EQ(session.receive(rest, 16).replies.size(), 16U);
    EXPECT_EQ(session.receive(rest, 16).replies.size(), 8U);
    EXPECT_TRUE(rest.empty());
}

TEST_F(SessionTest, TellsWhatItHoldsAndMayBeToldToRefuse) {
    hello();
    Message upload = request(MessageType::upload, R"({"hash":")" + std::string(64, 'a') + R"(","size":100,"offset":0})",
                             std::vector<std::byte>(100));
    upload.id = 99;
    const auto bytes = encoded(upload);
    EXPECT_EQ(session.held(), 0U);
    session.receive(std::span(bytes).first(bytes.size() - 40));
    EXPECT_EQ(session.held(), upload.json.size() + 60);
    const auto refused = session.refuse({"busy", "no memory"});
    EXPECT_EQ(codeOf(refused), "busy");
    EXPECT_EQ(refused.replies[0].id, 99U);
    EXPECT_TRUE(refused.close);
    EXPECT_TRUE(session.receive(encoded(request(MessageType::ping, ""))).replies.empty());
}

/// Every valid message with each of its bytes replaced: a reply, a request or patience, never anything else.
TEST_F(SessionTest, DamagedBytesAreAnsweredOrWaitedFor) {
    for (const Message& message : test::validMessages()) {
        const auto good = encoded(message);
        for (std::size_t at = 0; at < good.size(); ++at)
            for (const unsigned value : {0U, 0x22U, 0x5BU, 0x7FU, 0xFFU}) {
                Session one(policy);
                one.receive(encoded(request(MessageType::hello, R"({"token":"secret"})")));
                auto bytes = good;
                bytes[at] = static_cast<std::byte>(value);
                const auto result = one.receive(bytes);
                ASSERT_LE(result.replies.size() + result.requests.size(), 2U);
                for (const Message& reply : result.replies) ASSERT_TRUE(json::accept(reply.json));
            }
    }
}

}  // namespace
}  // namespace lumulus::service
