#include "base/free_list.h"

#include <iterator>
#include <stdexcept>

namespace lumulus {

FreeList::FreeList(std::uint64_t bytes) : bytes_(bytes) {
    insert(0, bytes);
}

void FreeList::insert(std::uint64_t offset, std::uint64_t bytes) {
    if (bytes == 0) return;
    byOffset_.emplace(offset, bytes);
    bySize_.emplace(bytes, offset);
    freeBytes_ += bytes;
}

void FreeList::erase(std::uint64_t offset, std::uint64_t bytes) {
    byOffset_.erase(offset);
    bySize_.erase({bytes, offset});
    freeBytes_ -= bytes;
}

std::optional<std::uint64_t> FreeList::take(std::uint64_t bytes, std::uint64_t alignment) {
    for (auto range = bySize_.lower_bound({bytes, 0}); range != bySize_.end(); ++range) {
        const auto [size, start] = *range;
        const std::uint64_t offset = (start + alignment - 1) / alignment * alignment;
        if (offset + bytes > start + size) continue;
        erase(start, size);
        insert(start, offset - start);
        insert(offset + bytes, start + size - offset - bytes);
        return offset;
    }
    return std::nullopt;
}

void FreeList::give(std::uint64_t offset, std::uint64_t bytes) {
    std::uint64_t begin = offset;
    std::uint64_t end = offset + bytes;
    const auto next = byOffset_.lower_bound(offset);
    const auto previous = next == byOffset_.begin() ? byOffset_.end() : std::prev(next);
    const bool overlaps = (next != byOffset_.end() && next->first < end) ||
                          (previous != byOffset_.end() && previous->first + previous->second > begin);
    if (overlaps || end > bytes_) throw std::logic_error("memory was given back that was not taken");
    if (next != byOffset_.end() && next->first == end) {
        const auto [start, size] = *next;
        end = start + size;
        erase(start, size);
    }
    if (previous != byOffset_.end() && previous->first + previous->second == begin) {
        const auto [start, size] = *previous;
        begin = start;
        erase(start, size);
    }
    insert(begin, end - begin);
}

}  // namespace lumulus
