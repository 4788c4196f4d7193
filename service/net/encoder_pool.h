#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <set>
#include <thread>
#include <utility>
#include <vector>

namespace lumulus::service {

/// Threads that work off tasks. Those of one lane are worked off one after the other, in the order in which they came,
/// so that a connection gets its frames in order. Of several lanes the task comes next that could have been done first:
/// a short one passes long ones, but none waits for ever. Holds as many tasks as it is given: who submits them bounds
/// them.
class EncoderPool {
  public:
    using Task = std::function<void()>;

    explicit EncoderPool(unsigned threads);
    EncoderPool(const EncoderPool&) = delete;
    EncoderPool& operator=(const EncoderPool&) = delete;
    ~EncoderPool();

    /// Takes a task that is foreseen to take so long. Tasks must not throw. After stop() they are dropped.
    void submit(std::uint64_t lane, std::chrono::nanoseconds length, Task task);
    void submit(std::uint64_t lane, Task task) { submit(lane, {}, std::move(task)); }
    /// Drops what waits, and returns when the tasks at hand have ended.
    void stop();

  private:
    struct Entry {
        std::uint64_t lane = 0;
        std::chrono::steady_clock::time_point couldBeDone;
        Task task;
    };

    void work();
    std::deque<Entry>::iterator next();

    std::mutex mutex_;  // guards what follows
    std::condition_variable wake_;
    std::deque<Entry> queue_;
    std::set<std::uint64_t> busy_;  // lanes of which a task is at work
    bool stopping_ = false;

    std::vector<std::thread> threads_;
};

}  // namespace lumulus::service
