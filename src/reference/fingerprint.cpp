#include "reference/fingerprint.h"

#include <algorithm>
#include <cstring>

namespace lumulus::reference {

Fingerprint& Fingerprint::add(std::span<const std::byte> bytes) {
    for (std::size_t i = 0; i < bytes.size(); i += sizeof(std::uint64_t)) {
        std::uint64_t word = 0;
        std::memcpy(&word, bytes.data() + i, std::min(sizeof(word), bytes.size() - i));
        value_ = (value_ ^ word) * 0x9E3779B97F4A7C15ULL;
        value_ ^= value_ >> 32U;
    }
    value_ ^= bytes.size();
    return *this;
}

}  // namespace lumulus::reference
