// Threads that encode: the order of a lane, lanes at once, and the end.
#include "service/net/encoder_pool.h"

#include <gtest/gtest.h>

#include <atomic>
#include <latch>
#include <map>
#include <vector>

namespace lumulus::service {
namespace {

TEST(EncoderPool, ALaneKeepsItsOrder) {
    constexpr int lanes = 3, tasks = 200;
    std::map<int, std::vector<int>> done;  // one lane writes one vector
    for (int lane = 0; lane < lanes; ++lane) done[lane];
    std::latch all(lanes * tasks);
    EncoderPool pool(4);
    for (int i = 0; i < tasks; ++i)
        for (int lane = 0; lane < lanes; ++lane)
            pool.submit(static_cast<std::uint64_t>(lane), [&done, &all, lane, i] {
                done.at(lane).push_back(i);
                all.count_down();
            });
    all.wait();
    for (const auto& [lane, order] : done)
        for (int i = 0; i < tasks; ++i) ASSERT_EQ(order.at(static_cast<std::size_t>(i)), i) << lane;
}

TEST(EncoderPool, LanesDoNotWaitForEachOther) {
    std::latch second(1), both(2);
    EncoderPool pool(2);
    pool.submit(1, [&] {
        second.wait();  // for a task that was submitted later
        both.count_down();
    });
    pool.submit(2, [&] {
        second.count_down();
        both.count_down();
    });
    both.wait();
}

/// A short task passes long ones of other lanes, none of its own, and not those that have waited longer than they take.
TEST(EncoderPool, ShortTasksPassLongOnes) {
    using std::chrono::hours;
    std::latch begun(1), goOn(1), all(5);
    std::vector<int> order;  // one thread
    EncoderPool pool(1);
    pool.submit(0, [&] {
        begun.count_down();
        goOn.wait();
    });
    begun.wait();
    const auto add = [&](std::uint64_t lane, std::chrono::nanoseconds length, int number) {
        pool.submit(lane, length, [&, number] {
            order.push_back(number);
            all.count_down();
        });
    };
    add(1, hours(2), 1);
    add(2, hours(1), 2);
    add(1, {}, 3);
    add(3, {}, 4);
    add(4, -hours(1), 5);
    goOn.count_down();
    all.wait();
    EXPECT_EQ(order, (std::vector<int>{5, 4, 2, 1, 3}));
}

TEST(EncoderPool, WhatWaitsIsDroppedAtTheEnd) {
    std::latch begun(1), goOn(1);
    std::atomic<int> done = 0;
    EncoderPool pool(1);
    pool.submit(1, [&] {
        begun.count_down();
        goOn.wait();
        ++done;
    });
    pool.submit(1, [&] { ++done; });
    begun.wait();
    std::thread ending([&] { pool.stop(); });
    pool.submit(2, [&] { done += 0; });
    goOn.count_down();
    ending.join();
    pool.submit(3, [&] { done += 100; });
    EXPECT_GE(done, 1);
    EXPECT_LE(done, 2);
}

}  // namespace
}  // namespace lumulus::service
