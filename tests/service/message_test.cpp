// Framing: what comes in pieces, cut off, or with lengths that lie.
#include "service/protocol/message.h"

#include <gtest/gtest.h>

#include <limits>

#include "support/service_messages.h"

namespace lumulus::service {
namespace {

using test::bytesOf;
using test::encoded;

TEST(Message, TheHeaderIsThatOfTheDocument) {
    const Message message{MessageType::frame, 0x0102030405060708ULL, "{}", bytesOf("abc")};
    const std::string expected(
        "LMLS\x01\0\x04\0\x08\x07\x06\x05\x04\x03\x02\x01\x02\0\0\0\0\0\0\0\x03\0\0\0\0\0\0\0{}abc", headerBytes + 5);
    EXPECT_EQ(encoded(message), bytesOf(expected));
}

TEST(Message, ReadsBackInPiecesOfAnySize) {
    std::vector<std::byte> stream;
    for (const Message& message : test::validMessages()) {
        const auto bytes = encoded(message);
        stream.insert(stream.end(), bytes.begin(), bytes.end());
    }
    for (const std::size_t piece : {1UL, 7UL, 31UL, 1000UL, stream.size()}) {
        MessageReader reader(MessageLimits{});
        std::vector<Message> read;
        for (std::size_t at = 0; at < stream.size(); at += piece) {
            std::span<const std::byte> bytes = std::span(stream).subspan(at, std::min(piece, stream.size() - at));
            while (auto message = reader.read(bytes)) read.push_back(std::move(*message));
            ASSERT_TRUE(bytes.empty());
        }
        EXPECT_EQ(read, test::validMessages());
        EXPECT_FALSE(reader.midMessage());
    }
}

TEST(Message, TruncatedAtEveryByteIsIncomplete) {
    for (const Message& message : test::validMessages()) {
        const auto bytes = encoded(message);
        for (std::size_t length = 0; length < bytes.size(); ++length) {
            MessageReader reader(MessageLimits{});
            std::span<const std::byte> part(bytes.data(), length);
            ASSERT_FALSE(reader.read(part).has_value());
            ASSERT_EQ(reader.midMessage(), length > 0);
        }
    }
}

TEST(Message, LengthsAtTheirExtremesAreRefusedOrWaitedFor) {
    const MessageLimits limits{100, 1000};
    for (const std::uint32_t json : {0U, 1U, 100U, 101U, 0x7FFFFFFFU, 0xFFFFFFFFU})
        for (const std::uint64_t payload : {std::uint64_t{0}, std::uint64_t{1000}, std::uint64_t{1001},
                                            std::uint64_t{1} << 63U, std::numeric_limits<std::uint64_t>::max()}) {
            MessageReader reader(limits);
            const auto header = encodeHeader({protocolVersion, MessageType::ping, 9, json, payload});
            std::span<const std::byte> bytes(header);
            if (json > limits.jsonBytes || payload > limits.payloadBytes) {
                try {
                    reader.read(bytes);
                    FAIL() << json << " " << payload;
                } catch (const FramingError& e) {
                    EXPECT_EQ(e.code, "too_large");
                    EXPECT_EQ(e.id, 9U);
                }
            } else {
                EXPECT_EQ(reader.read(bytes).has_value(), json == 0 && payload == 0);
            }
        }
}

TEST(Message, OtherMagicVersionOrReservedBitsAreRefused) {
    const auto good = encodeHeader({protocolVersion, MessageType::ping, 9, 0, 0});
    const auto refused = [&](std::size_t at, unsigned value) {
        auto bytes = good;
        bytes.at(at) = static_cast<std::byte>(value);
        try {
            decodeHeader(bytes);
        } catch (const FramingError& e) {
            return e.code;
        }
        return std::string("accepted");
    };
    EXPECT_EQ(refused(0, 'G'), "bad_message");
    EXPECT_EQ(refused(4, 2), "unsupported_version");
    EXPECT_EQ(refused(5, 1), "unsupported_version");
    EXPECT_EQ(refused(20, 1), "bad_message");
    EXPECT_EQ(refused(6, 99), "accepted");  // another type is the session's matter
}

}  // namespace
}  // namespace lumulus::service
