#include "base/text.h"

#include <fmt/format.h>

#include <cstdint>

namespace lumulus {
namespace {

bool isContinuation(char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
}

/// Number of bytes of the UTF-8 character at the beginning of `text` (RFC 3629); 0 if it is not well-formed.
std::size_t characterLength(std::string_view text) {
    const auto first = static_cast<unsigned char>(text[0]);
    if (first < 0x80) return 1;
    const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
    if (first < 0xC2 || first > 0xF4 || text.size() < length) return 0;
    std::uint32_t code = first & (0x7FU >> length);
    for (std::size_t i = 1; i < length; ++i) {
        if (!isContinuation(text[i])) return 0;
        code = (code << 6U) | (static_cast<unsigned char>(text[i]) & 0x3FU);
    }
    constexpr std::uint32_t shortest[5] = {0, 0, 0x80, 0x800, 0x10000};
    const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
    return code < shortest[length] || code > 0x10FFFF || surrogate ? 0 : length;
}

/// True for the control characters U+0000 to U+001F, U+007F, and U+0080 to U+009F (two bytes).
bool isControl(std::string_view character) {
    const auto first = static_cast<unsigned char>(character[0]);
    return first < 0x20 || first == 0x7F || (first == 0xC2 && static_cast<unsigned char>(character[1]) < 0xA0);
}

}  // namespace

std::string oneLine(std::string_view text) {
    std::string line;
    while (!text.empty()) {
        const std::size_t length = characterLength(text);
        const std::string_view character = text.substr(0, length == 0 ? 1 : length);
        text.remove_prefix(character.size());
        if (character == "\n" || character == "\r" || character == "\t") {
            line += ' ';
        } else if (length == 0 || isControl(character)) {
            for (const char c : character) line += fmt::format("\\x{:02X}", static_cast<unsigned char>(c));
        } else {
            line += character;
        }
    }
    while (!line.empty() && line.back() == ' ') line.pop_back();
    return line;
}

std::string shortened(std::string_view text, std::size_t most) {
    if (text.size() <= most) return std::string(text);
    std::size_t head = most / 2;
    std::size_t tail = text.size() - (most - head);
    while (head > 0 && isContinuation(text[head])) --head;
    while (tail < text.size() && isContinuation(text[tail])) ++tail;
    return fmt::format("{} … {} bytes … {}", text.substr(0, head), tail - head, text.substr(tail));
}

}  // namespace lumulus
