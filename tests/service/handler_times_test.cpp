// How long handlers of a thread take: what they work and what they wait.
#include "service/net/handler_times.h"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>

#include <atomic>
#include <string_view>
#include <thread>

#include "service/telemetry/metrics.h"

namespace lumulus::service {
namespace {

using std::chrono::milliseconds;

std::int64_t valueOf(const Metrics& metrics, std::string_view name) {
    for (const auto& [each, value] : metrics.values())
        if (each == name) return value;
    return -1;
}

TEST(HandlerTimes, LongestAndSlowOnes) {
    Metrics metrics;
    const auto longest = [&] { return valueOf(metrics, "io_longest_handler_microseconds"); };
    const auto slow = [&] { return valueOf(metrics, "io_slow_handlers_total"); };
    {
        const HandlerTimes times(metrics);
        { const HandlerTimer timer; }
        EXPECT_LT(longest(), 1000);
        EXPECT_EQ(slow(), 0);
        {
            const HandlerTimer timer;
            std::this_thread::sleep_for(milliseconds(15));
        }
        EXPECT_GE(longest(), 15000);
        EXPECT_EQ(slow(), 1);
    }
    const std::int64_t before = longest();
    {
        const HandlerTimer timer;  // of a thread that nobody asks for
        std::this_thread::sleep_for(milliseconds(40));
    }
    EXPECT_EQ(longest(), before);
}

/// A thread is pinned to a core that another one keeps busy: it waits about as long as it works.
TEST(HandlerTimes, WaitingForACoreIsNotTheHandlers) {
    Metrics metrics;
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(::sched_getcpu(), &one);
    std::atomic<bool> ends{false};
    const auto pinned = [&one] { ASSERT_EQ(::pthread_setaffinity_np(::pthread_self(), sizeof one, &one), 0); };
    std::thread other([&] {
        pinned();
        while (!ends) continue;
    });
    std::chrono::nanoseconds waited{};
    std::int64_t took = 0;
    const auto begun = std::chrono::steady_clock::now();
    std::thread handler([&] {
        pinned();
        const HandlerTimes times(metrics);
        {
            const HandlerTimer timer;
            while (std::chrono::steady_clock::now() - begun < milliseconds(200)) continue;
        }
        waited = times.waitedForCore();
        took = valueOf(metrics, "io_longest_handler_microseconds");
    });
    handler.join();
    ends = true;
    other.join();
    EXPECT_GT(waited, milliseconds(40));
    EXPECT_NEAR(1e-3 * static_cast<double>(took), 200.0 - 1e-6 * static_cast<double>(waited.count()), 20.0);
}

}  // namespace
}  // namespace lumulus::service
