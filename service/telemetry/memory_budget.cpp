#include "service/telemetry/memory_budget.h"

namespace lumulus::service {
namespace {

constexpr std::array<Metrics::Name, MemoryBudget::uses> gauges{Metrics::memoryMessages, Metrics::memoryUploads,
                                                               Metrics::memoryFrames, Metrics::memoryScenes};

}  // namespace

MemoryBudget::MemoryBudget(std::uint64_t limit, Metrics& metrics) : limit_(limit), metrics_(metrics) {
    metrics_.set(Metrics::memoryLimit, static_cast<std::int64_t>(limit));
}

/// Tells the metrics of bytes that used_ has counted.
void MemoryBudget::count(Use use, std::int64_t difference) {
    metrics_.add(gauges.at(use), difference);
    metrics_.add(Metrics::memoryUsed, difference);
}

/// Takes `more` bytes for a share that holds some.
bool MemoryBudget::reserve(Use use, std::uint64_t held, std::uint64_t more) {
    std::uint64_t used = used_.load();
    do {
        const std::uint64_t free = used < limit_ ? limit_ - used : 0;
        if (more > free || (use != scenes && held + more > (free + held) / 2)) {
            metrics_.add(Metrics::memoryRefusals);
            return false;
        }
    } while (!used_.compare_exchange_weak(used, used + more));
    count(use, static_cast<std::int64_t>(more));
    return true;
}

MemoryBudget::Share MemoryBudget::hold(Use use, std::uint64_t bytes) {
    Share share(*this, use);
    share.resize(bytes);
    return share;
}

std::optional<MemoryBudget::Share> MemoryBudget::take(Use use, std::uint64_t bytes) {
    Share share(*this, use);
    if (!share.tryResize(bytes)) return std::nullopt;
    return share;
}

void MemoryBudget::Share::resize(std::uint64_t bytes) {
    if (budget_ == nullptr || bytes == bytes_) return;
    const auto difference = static_cast<std::int64_t>(bytes) - static_cast<std::int64_t>(bytes_);
    budget_->used_ += static_cast<std::uint64_t>(difference);
    budget_->count(use_, difference);
    bytes_ = bytes;
}

bool MemoryBudget::Share::tryResize(std::uint64_t bytes) {
    if (budget_ != nullptr && bytes > bytes_) {
        if (!budget_->reserve(use_, bytes_, bytes - bytes_)) return false;
        bytes_ = bytes;
    } else {
        resize(bytes);
    }
    return true;
}

}  // namespace lumulus::service
