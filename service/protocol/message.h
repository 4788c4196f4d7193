#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

/// The frame service. docs/protocol.md is the contract; this is its framing.
namespace lumulus::service {

inline constexpr std::uint32_t messageMagic = 0x534C4D4CU;  ///< "LMLS"
inline constexpr std::uint16_t protocolVersion = 1;
inline constexpr std::size_t headerBytes = 32;

/// A reply has the type of its request with `replyBit`; an error has type `error`.
enum class MessageType : std::uint16_t {
    hello = 1,
    loadScene = 2,
    upload = 3,
    frame = 4,
    startStream = 5,
    stopStream = 6,
    composite = 7,
    cancel = 8,
    statistics = 9,
    ping = 10,
    change = 11,
    listUploads = 12,
    deleteUpload = 13,
    listScenes = 14,
    query = 15,
    error = 0x8000,
};
inline constexpr std::uint16_t replyBit = 0x8000;

/// The name of a type: "frame", "start_stream", …; "unknown" for a number that is no type.
const char* messageName(MessageType type);

constexpr MessageType replyTo(MessageType request) {
    return static_cast<MessageType>(static_cast<std::uint16_t>(request) | replyBit);
}

struct MessageHeader {
    std::uint16_t version = protocolVersion;
    MessageType type = MessageType::error;
    std::uint64_t id = 0;  ///< chosen by the one who asks, echoed by the reply
    std::uint32_t jsonBytes = 0;
    std::uint64_t payloadBytes = 0;

    bool operator==(const MessageHeader&) const = default;
};

struct Message {
    MessageType type = MessageType::error;
    std::uint64_t id = 0;
    std::string json;
    std::vector<std::byte> payload;

    bool operator==(const Message&) const = default;
};

/// Thrown where bytes break the framing, so that none after them can be trusted: the connection ends with it.
class FramingError : public std::runtime_error {
  public:
    FramingError(std::string errorCode, std::uint64_t requestId, const std::string& text)
        : std::runtime_error(text), code(std::move(errorCode)), id(requestId) {}
    std::string code;  ///< bad_message, unsupported_version or too_large
    std::uint64_t id;  ///< of the message, 0 where it could not be read
};

std::array<std::byte, headerBytes> encodeHeader(const MessageHeader& header);

/// Reads a header. Errors: FramingError for another magic or version, and for reserved bits that are set.
MessageHeader decodeHeader(std::span<const std::byte, headerBytes> bytes);

/// Encodes header and JSON of a message: the part before the payload.
std::vector<std::byte> encodeHead(const Message& message);

/// The largest message that is taken.
struct MessageLimits {
    std::uint32_t jsonBytes = 1U << 16U;
    std::uint64_t payloadBytes = std::uint64_t{64} << 20U;
};

/// Takes bytes in pieces of any size and gives messages back. Holds one message at most, as far as it has arrived;
/// room for the length that a header claims is reserved when the first MiB has come, and filled by the bytes alone.
class MessageReader {
  public:
    explicit MessageReader(MessageLimits limits) : limits_(limits) {}
    void setLimits(MessageLimits limits) { limits_ = limits; }

    /// Takes bytes off the front of `bytes` until a message is complete or they are used up.
    /// Errors: FramingError, also for a length beyond the limits; the reader is of no use then.
    std::optional<Message> read(std::span<const std::byte>& bytes);

    /// Whether a message has begun and is not complete.
    bool midMessage() const { return !head_.empty() || header_.has_value(); }
    /// Bytes of JSON and payload that have arrived of a message that is not complete.
    std::uint64_t held() const { return header_ ? message_.json.size() + message_.payload.size() : 0; }
    /// Id of that message; 0 where none has begun.
    std::uint64_t id() const { return header_ ? header_->id : 0; }

  private:
    MessageLimits limits_;
    std::vector<std::byte> head_;  // as much of a header as is there
    std::optional<MessageHeader> header_;
    Message message_;
};

}  // namespace lumulus::service
