#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <utility>

#include "service/telemetry/metrics.h"

namespace lumulus::service {

/// The bytes that clients may make the process hold: messages, uploads, frames and scenes draw from one limit. What the
/// program needs by itself comes on top. For any thread; must outlive its shares.
class MemoryBudget {
  public:
    enum Use { messages, uploads, frames, scenes, uses };

    MemoryBudget(std::uint64_t limit, Metrics& metrics);
    MemoryBudget(const MemoryBudget&) = delete;
    MemoryBudget& operator=(const MemoryBudget&) = delete;

    /// Bytes that are held as long as this lives.
    class Share {
      public:
        Share() = default;
        Share(Share&& other) noexcept { swap(other); }
        Share& operator=(Share&& other) noexcept {
            swap(other);
            return *this;
        }
        ~Share() { resize(0); }

        std::uint64_t bytes() const { return bytes_; }
        /// Counts what is held now, whether there is room or not. A share without a budget counts nothing.
        void resize(std::uint64_t bytes);
        /// Like resize(). Returns false, and changes nothing, where the budget does not have the bytes.
        bool tryResize(std::uint64_t bytes);

      private:
        friend class MemoryBudget;
        Share(MemoryBudget& budget, Use use) : budget_(&budget), use_(use) {}
        void swap(Share& other) noexcept {
            std::swap(budget_, other.budget_);
            std::swap(use_, other.use_);
            std::swap(bytes_, other.bytes_);
        }

        MemoryBudget* budget_ = nullptr;
        Use use_ = messages;
        std::uint64_t bytes_ = 0;
    };

    /// A share of nothing, to be resized.
    Share open(Use use) { return {*this, use}; }
    /// A share of what is there already.
    Share hold(Use use, std::uint64_t bytes);
    /// A share where the budget has it; else none. Scenes may take all that is free. Of everything else one share is at
    /// most half of what is free, so that who asks for much leaves room for those who ask for little.
    std::optional<Share> take(Use use, std::uint64_t bytes);

    std::uint64_t limit() const { return limit_; }
    std::uint64_t used() const { return used_.load(); }

  private:
    void count(Use use, std::int64_t difference);
    bool reserve(Use use, std::uint64_t held, std::uint64_t more);

    std::uint64_t limit_;
    Metrics& metrics_;
    std::atomic<std::uint64_t> used_{0};
};

}  // namespace lumulus::service
