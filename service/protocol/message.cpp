#include "service/protocol/message.h"

#include <algorithm>
#include <concepts>
#include <cstring>

namespace lumulus::service {
namespace {

// Offsets in the header, docs/protocol.md.
constexpr std::size_t magicAt = 0, versionAt = 4, typeAt = 6, idAt = 8, jsonAt = 16, reservedAt = 20, payloadAt = 24;

template <std::unsigned_integral Number>
void put(std::span<std::byte> bytes, std::size_t at, Number value) {
    for (std::size_t i = 0; i < sizeof(Number); ++i) bytes[at + i] = static_cast<std::byte>((value >> (8 * i)) & 0xFFU);
}

template <std::unsigned_integral Number>
Number get(std::span<const std::byte> bytes, std::size_t at) {
    Number value = 0;
    for (std::size_t i = 0; i < sizeof(Number); ++i)
        value = static_cast<Number>(value | static_cast<Number>(std::to_integer<Number>(bytes[at + i]) << (8 * i)));
    return value;
}

/// From this size on a payload gets the room that its header claims, so that it is not copied again and again.
constexpr std::size_t sizeableBytes = std::size_t{1} << 20U;

/// Appends to `to` until it has `wanted` elements or nothing is left.
template <class Container>
void take(Container& to, std::size_t wanted, std::span<const std::byte>& from) {
    const std::size_t count = std::min(wanted - to.size(), from.size());
    const auto* data = reinterpret_cast<const typename Container::value_type*>(from.data());
    to.insert(to.end(), data, data + count);
    from = from.subspan(count);
}

}  // namespace

const char* messageName(MessageType type) {
    switch (static_cast<MessageType>(static_cast<std::uint16_t>(type) & ~replyBit)) {
        case MessageType::hello:
            return "hello";
        case MessageType::loadScene:
            return "load_scene";
        case MessageType::upload:
            return "upload";
        case MessageType::frame:
            return "frame";
        case MessageType::startStream:
            return "start_stream";
        case MessageType::stopStream:
            return "stop_stream";
        case MessageType::composite:
            return "composite";
        case MessageType::cancel:
            return "cancel";
        case MessageType::statistics:
            return "statistics";
        case MessageType::ping:
            return "ping";
        case MessageType::change:
            return "change";
        case MessageType::query:
            return "query";
        case MessageType::listUploads:
            return "list_uploads";
        case MessageType::deleteUpload:
            return "delete_upload";
        case MessageType::listScenes:
            return "list_scenes";
        case MessageType::error:
            break;
    }
    return type == MessageType::error ? "error" : "unknown";
}

std::array<std::byte, headerBytes> encodeHeader(const MessageHeader& header) {
    std::array<std::byte, headerBytes> bytes{};
    put(bytes, magicAt, messageMagic);
    put(bytes, versionAt, header.version);
    put(bytes, typeAt, static_cast<std::uint16_t>(header.type));
    put(bytes, idAt, header.id);
    put(bytes, jsonAt, header.jsonBytes);
    put(bytes, payloadAt, header.payloadBytes);
    return bytes;
}

MessageHeader decodeHeader(std::span<const std::byte, headerBytes> bytes) {
    if (get<std::uint32_t>(bytes, magicAt) != messageMagic)
        throw FramingError("bad_message", 0, "this is no message of the frame service: it does not begin with LMLS");
    MessageHeader header;
    header.version = get<std::uint16_t>(bytes, versionAt);
    header.id = get<std::uint64_t>(bytes, idAt);
    if (header.version != protocolVersion)
        throw FramingError("unsupported_version", header.id,
                           "version " + std::to_string(header.version) + " of the protocol is not spoken here, only " +
                               std::to_string(protocolVersion));
    if (get<std::uint32_t>(bytes, reservedAt) != 0)
        throw FramingError("bad_message", header.id, "reserved bytes of the header are not 0");
    header.type = static_cast<MessageType>(get<std::uint16_t>(bytes, typeAt));
    header.jsonBytes = get<std::uint32_t>(bytes, jsonAt);
    header.payloadBytes = get<std::uint64_t>(bytes, payloadAt);
    return header;
}

std::vector<std::byte> encodeHead(const Message& message) {
    const auto header =
        encodeHeader({protocolVersion, message.type, message.id, static_cast<std::uint32_t>(message.json.size()),
                      static_cast<std::uint64_t>(message.payload.size())});
    std::vector<std::byte> head(headerBytes + message.json.size());
    std::ranges::copy(header, head.begin());
    std::ranges::copy(std::as_bytes(std::span(message.json)), head.begin() + headerBytes);
    return head;
}

std::optional<Message> MessageReader::read(std::span<const std::byte>& bytes) {
    if (!header_) {
        take(head_, headerBytes, bytes);
        if (head_.size() < headerBytes) return std::nullopt;
        const MessageHeader header = decodeHeader(std::span<const std::byte, headerBytes>(head_));
        if (header.jsonBytes > limits_.jsonBytes || header.payloadBytes > limits_.payloadBytes)
            throw FramingError("too_large", header.id,
                               "a message may hold " + std::to_string(limits_.jsonBytes) + " bytes of JSON and " +
                                   std::to_string(limits_.payloadBytes) + " of payload here");
        header_ = header;
        head_.clear();
        message_ = Message{header.type, header.id, {}, {}};
    }
    take(message_.json, header_->jsonBytes, bytes);
    if (message_.payload.size() >= sizeableBytes) message_.payload.reserve(header_->payloadBytes);
    take(message_.payload, header_->payloadBytes, bytes);
    if (message_.json.size() < header_->jsonBytes || message_.payload.size() < header_->payloadBytes)
        return std::nullopt;
    header_.reset();
    return std::move(message_);
}

}  // namespace lumulus::service
