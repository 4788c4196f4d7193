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

void EncoderPool::submit(std::uint64_t lane, std::chrono::nanoseconds length, Task task) {
    {
        const std::lock_guard lock(mutex_);
        if (stopping_) return;
        queue_.push_back({lane, std::chrono::steady_clock::now() + length, std::move(task)});
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

/// With the lock held: of the oldest tasks of all lanes that are free, the one that could have been done first.
std::deque<EncoderPool::Entry>::iterator EncoderPool::next() {
    std::set<std::uint64_t> passed = busy_;
    auto best = queue_.end();
    for (auto it = queue_.begin(); it != queue_.end(); ++it) {
        if (!passed.insert(it->lane).second) continue;
        if (best == queue_.end() || it->couldBeDone < best->couldBeDone) best = it;
    }
    return best;
}

void EncoderPool::work() {
    std::unique_lock lock(mutex_);
    while (true) {
        wake_.wait(lock, [this] { return stopping_ || next() != queue_.end(); });
        if (stopping_) return;
        const auto chosen = next();
        Entry entry = std::move(*chosen);
        queue_.erase(chosen);
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
