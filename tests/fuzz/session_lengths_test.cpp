// Conversations with lengths that a fuzzer finds late.
#include <gtest/gtest.h>

#include "fuzz/session_input.h"
#include "support/service_messages.h"

namespace lumulus::service {
namespace {

std::vector<std::byte> withHello(const Message& message) {
    std::vector<std::byte> bytes{std::byte{12}};
    const Message hello = test::request(MessageType::hello, R"({"version":1,"token":"secret"})");
    for (const Message& one : {hello, message}) {
        const auto encoded = test::encoded(one);
        bytes.insert(bytes.end(), encoded.begin(), encoded.end());
    }
    return bytes;
}

TEST(SessionLengths, AtTheirExtremesKeepPromises) {
    for (const Message& message : test::validMessages()) {
        const auto good = withHello(message);
        const std::size_t second = good.size() - test::encoded(message).size();
        EXPECT_NO_THROW(test::feedSession(good));
        for (const std::size_t field : {16UL, 24UL})  // lengths of JSON and payload
            for (const unsigned value : {0x00U, 0x01U, 0x7FU, 0x80U, 0xFFU})
                for (std::size_t byte = 0; byte < (field == 16 ? 4U : 8U); ++byte) {
                    auto bytes = good;
                    bytes[second + field + byte] = static_cast<std::byte>(value);
                    EXPECT_NO_THROW(test::feedSession(bytes));
                }
        for (std::size_t length = 0; length < good.size(); ++length)
            ASSERT_NO_THROW(test::feedSession(std::span(good).first(length)));
    }
}

}  // namespace
}  // namespace lumulus::service
