// How long handlers of a thread take: what they work and what they wait.
#include "service/net/handler_times.h"

#include <gtest/gtest.h>

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
        // asleep, where no other thread took the core in that very time
        for (int attempt = 0; attempt < 100 && slow() == 0; ++attempt) {
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

}  // namespace
}  // namespace lumulus::service
