#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

namespace lumulus::reference {

/// A 64-bit hash of values, by their bytes (FNV-1a over words, mixed): equal inputs give equal numbers.
class Fingerprint {
  public:
    Fingerprint& add(std::span<const std::byte> bytes);

    template <typename T>
    Fingerprint& add(const T& value) {
        static_assert(std::has_unique_object_representations_v<T> || std::is_floating_point_v<T>);
        return add(std::as_bytes(std::span(&value, 1)));
    }

    std::uint64_t value() const { return value_; }

  private:
    std::uint64_t value_ = 0xCBF29CE484222325ULL;
};

}  // namespace lumulus::reference
