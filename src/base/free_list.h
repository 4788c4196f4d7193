#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace lumulus {

/// The free ranges of one block of memory. A request gets the smallest range that fits (best fit, the lowest offset
/// among equals), so the same calls give the same offsets. Neighbours merge when they come back.
/// A plain value: it counts bytes and never touches the memory.
class FreeList {
  public:
    /// A block of `bytes` bytes, all free.
    explicit FreeList(std::uint64_t bytes);

    /// Takes `bytes` bytes (at least 1) at a multiple of `alignment` (a power of two). Returns their offset, or nothing
    /// where no range is large enough.
    std::optional<std::uint64_t> take(std::uint64_t bytes, std::uint64_t alignment);
    /// Gives back one range that take() returned. Throws std::logic_error where a part of it is free already.
    void give(std::uint64_t offset, std::uint64_t bytes);

    /// True when everything is free.
    bool unused() const { return freeBytes_ == bytes_; }
    std::uint64_t freeBytes() const { return freeBytes_; }
    std::size_t ranges() const { return byOffset_.size(); }

  private:
    void insert(std::uint64_t offset, std::uint64_t bytes);
    void erase(std::uint64_t offset, std::uint64_t bytes);

    std::uint64_t bytes_;
    std::uint64_t freeBytes_ = 0;
    std::map<std::uint64_t, std::uint64_t> byOffset_;           ///< size by offset
    std::set<std::pair<std::uint64_t, std::uint64_t>> bySize_;  ///< size and offset
};

}  // namespace lumulus
