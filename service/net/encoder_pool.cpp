#include "service/net/encoder_pool.h"

#include <algorithm>
#include <utility>

namespace lumulus::service {

EncoderPool::EncoderPool(unsigned threads) {
    for (unsigned i = 0; i < std::max(1U, threads); ++i) threads_.emplace_back([this] { work(); });
}

EncoderPool::~EncoderPool() {
    stop();
}

void EncoderPool::submit(std::uint64_t lane, Task task) {
    {
        const std::lock_guard lock(mutex_);
        if (stopping_) return;
        queue_.push_back({lane, std::move(task)});
    }
    wake_.notify_one();
}

void EncoderPool::stop() {
    std::deque<Entry> dropped;  // ends after the lock
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
        dropped = std::exchange(queue_, {});
    }
    wake_.notify_all();
    for (std::thread& thread : threads_)
        if (thread.joinable()) thread.join();
}

/// With the lock held: the oldest task of a lane that is free.
std::deque<EncoderPool::Entry>::iterator EncoderPool::next() {
    return std::ranges::find_if(queue_, [this](const Entry& entry) { return !busy_.contains(entry.lane); });
}

void EncoderPool::work() {
    std::unique_lock lock(mutex_);
    while (true) {
        wake_.wait(lock, [this] { return stopping_ || next() != queue_.end(); });
        if (stopping_) return;
        const auto oldest = next();
        Entry entry = std::move(*oldest);
        queue_.erase(oldest);
        busy_.insert(entry.lane);
        lock.unlock();
        entry.task();
        entry.task = {};  // what it holds ends without the lock
        lock.lock();
        busy_.erase(entry.lane);
        wake_.notify_one();  // the next task of the lane may have waited
    }
}

}  // namespace lumulus::service
