#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace lumulus::reference {

/// Random numbers of one path: xoshiro256++ (Blackman and Vigna 2021), seeded by splitmix64 from a key. The numbers of
/// a path depend on its key alone, not on threads or the order of work.
class Random {
  public:
    Random(std::uint64_t seed, std::uint64_t stream, std::uint64_t path) {
        std::uint64_t x = mixed(mixed(mixed(seed) + stream) + path);
        for (std::uint64_t& word : state_) {
            x += golden;
            word = mixed(x);
        }
    }

    /// In [0, 1), a multiple of 2⁻⁵³.
    double uniform() { return static_cast<double>(next() >> 11U) * 0x1p-53; }

    /// In (0, 1].
    double uniformAboveZero() { return static_cast<double>((next() >> 11U) + 1) * 0x1p-53; }

    /// Exponential with mean 1: the optical depth up to a collision.
    double exponential() { return -std::log(uniformAboveZero()); }

  private:
    static constexpr std::uint64_t golden = 0x9E3779B97F4A7C15ULL;

    static std::uint64_t mixed(std::uint64_t x) {
        x += golden;
        x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9ULL;
        x = (x ^ (x >> 27U)) * 0x94D049BB133111EBULL;
        return x ^ (x >> 31U);
    }

    std::uint64_t next() {
        const std::uint64_t result = std::rotl(state_[0] + state_[3], 23) + state_[0];
        const std::uint64_t shifted = state_[1] << 17U;
        state_[2] ^= state_[0];
        state_[3] ^= state_[1];
        state_[1] ^= state_[2];
        state_[0] ^= state_[3];
        state_[2] ^= shifted;
        state_[3] = std::rotl(state_[3], 45);
        return result;
    }

    std::array<std::uint64_t, 4> state_;
};

}  // namespace lumulus::reference
