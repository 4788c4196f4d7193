#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace lumulus::service {

/// SHA-256 (FIPS 180-4) of bytes that come in pieces.
class Sha256 {
  public:
    Sha256();
    Sha256(Sha256&&) noexcept;
    Sha256& operator=(Sha256&&) noexcept;
    ~Sha256();

    void update(std::span<const std::byte> bytes);
    /// The hash of all bytes so far, as 64 digits 0-9 a-f. Nothing may be added after it.
    std::string hex();

  private:
    struct State;
    std::unique_ptr<State> state_;
};

std::string sha256Hex(std::span<const std::byte> bytes);

/// Whether two secrets are equal. The time that it takes depends on neither.
bool equalSecrets(std::string_view a, std::string_view b);

}  // namespace lumulus::service
