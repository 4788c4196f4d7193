// What the service shares out: memory, guesses of tokens, the patience with slow readers, the heartbeat, the log.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "service/net/seats.h"
#include "service/net/token_guard.h"
#include "service/net/write_rate.h"
#include "service/render/heartbeat.h"
#include "service/telemetry/instruments.h"

namespace lumulus::service {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

std::int64_t valueOf(const Metrics& metrics, std::string_view name) {
    for (const auto& [known, value] : metrics.values())
        if (known == name) return value;
    return -1;
}

TEST(MemoryBudget, IsDrawnFromAndGivenBack) {
    Metrics metrics;
    MemoryBudget budget(1000, metrics);
    {
        const auto scene = budget.take(MemoryBudget::scenes, 600);
        ASSERT_TRUE(scene);
        EXPECT_EQ(budget.used(), 600U);
        EXPECT_FALSE(budget.take(MemoryBudget::scenes, 401));
        EXPECT_EQ(valueOf(metrics, "memory_scenes_bytes"), 600);
        EXPECT_EQ(valueOf(metrics, "memory_bytes"), 600);
        EXPECT_EQ(valueOf(metrics, "memory_refusals_total"), 1);
    }
    EXPECT_EQ(budget.used(), 0U);
    EXPECT_EQ(valueOf(metrics, "memory_scenes_bytes"), 0);
    EXPECT_EQ(valueOf(metrics, "memory_limit_bytes"), 1000);
}

TEST(MemoryBudget, NobodyButScenesTakesMoreThanHalfOfWhatIsFree) {
    Metrics metrics;
    MemoryBudget budget(1000, metrics);
    EXPECT_FALSE(budget.take(MemoryBudget::frames, 501));
    const auto first = budget.take(MemoryBudget::frames, 500);
    EXPECT_FALSE(budget.take(MemoryBudget::uploads, 251));
    const auto second = budget.take(MemoryBudget::uploads, 250);
    EXPECT_TRUE(first && second);
    EXPECT_TRUE(budget.take(MemoryBudget::scenes, 250));
    auto growing = budget.open(MemoryBudget::messages);
    EXPECT_TRUE(growing.tryResize(100));
    EXPECT_FALSE(growing.tryResize(130));  // of 250, in however many steps
    EXPECT_TRUE(growing.tryResize(125));
}

TEST(MemoryBudget, SharesGrowMoveAndEnd) {
    Metrics metrics;
    MemoryBudget budget(1000, metrics);
    MemoryBudget::Share share = budget.open(MemoryBudget::messages);
    EXPECT_TRUE(share.tryResize(400));
    EXPECT_FALSE(share.tryResize(800));
    EXPECT_EQ(share.bytes(), 400U);
    MemoryBudget::Share moved = std::move(share);
    EXPECT_EQ(budget.used(), 400U);
    moved.resize(2000);  // it is there, whatever the limit
    EXPECT_EQ(budget.used(), 2000U);
    EXPECT_FALSE(budget.take(MemoryBudget::frames, 1));
    moved = {};
    EXPECT_EQ(budget.used(), 0U);
    MemoryBudget::Share none;
    EXPECT_TRUE(none.tryResize(1U << 30U));
}

TEST(TokenGuard, LetsAFewThroughAndThenSoManyASecond) {
    TokenGuard guard(2.0, 3.0);
    const Clock::time_point start{};
    for (int i = 0; i < 3; ++i) EXPECT_EQ(guard.take("1.2.3.4", start), Clock::duration::zero());
    EXPECT_EQ(guard.take("1.2.3.4", start), milliseconds(500));
    EXPECT_EQ(guard.take("5.6.7.8", start), Clock::duration::zero());
    EXPECT_EQ(guard.take("1.2.3.4", start + milliseconds(500)), Clock::duration::zero());
    EXPECT_GT(guard.take("1.2.3.4", start + milliseconds(500)), Clock::duration::zero());
    guard.giveBack("1.2.3.4");  // it was right
    EXPECT_EQ(guard.take("1.2.3.4", start + milliseconds(500)), Clock::duration::zero());
}

TEST(TokenGuard, RemembersABoundedNumberOfOrigins) {
    TokenGuard guard(1.0, 2.0);
    const Clock::time_point start{};
    for (int i = 0; i < 20000; ++i) guard.take(std::to_string(i), start);
    EXPECT_LE(guard.size(), 4097U);
    EXPECT_GT(guard.take("another", start), Clock::duration::zero());
    EXPECT_EQ(guard.take("another", start + seconds(10)), Clock::duration::zero());
    EXPECT_LE(guard.size(), 2U);
}

TEST(TokenGuard, AnOriginIsAnAddressWithoutItsPort) {
    EXPECT_EQ(originOf("127.0.0.1:40000"), "127.0.0.1");
    EXPECT_EQ(originOf("127.0.0.1:40000 websocket"), "127.0.0.1");
    EXPECT_EQ(originOf("[2001:db8:1:2:3:4:5:6]:40000 websocket"), "2001:db8:1:2::");
    EXPECT_EQ(originOf("unix uid 1000"), "unix uid 1000");
}

TEST(WriteRate, AsksForBytesNotForSigns) {
    WriteRate rate(10.0, 100.0);
    const Clock::time_point start{};
    EXPECT_FALSE(rate.tooSlow(start + seconds(100)));  // nothing waits
    rate.begin(start);
    EXPECT_FALSE(rate.tooSlow(start + seconds(9)));
    rate.wrote(1000);
    EXPECT_FALSE(rate.tooSlow(start + seconds(10)));
    for (int i = 0; i < 10; ++i) rate.wrote(1);  // a byte a second
    EXPECT_FALSE(rate.tooSlow(start + seconds(19)));
    EXPECT_TRUE(rate.tooSlow(start + seconds(20)));
    rate.end();
    rate.begin(start + seconds(20));
    EXPECT_FALSE(rate.tooSlow(start + seconds(29)));
}

TEST(Seats, AreFreeAgainWhenTheirConnectionEnds) {
    std::shared_ptr<void> late;
    {
        Seats seats(2);
        const auto one = seats.take();
        late = seats.take();
        EXPECT_TRUE(one && late);
        EXPECT_FALSE(seats.take());
        late.reset();
        late = seats.take();
        EXPECT_TRUE(late);
    }
    late.reset();  // after the seats
}

TEST(Heartbeat, IsSilentOnlyAtWork) {
    Heartbeat heartbeat;
    const auto later = Clock::now() + seconds(100);
    EXPECT_EQ(heartbeat.silentSeconds(later), 0.0);
    heartbeat.step();
    EXPECT_NEAR(heartbeat.silentSeconds(later), 100.0, 1.0);
    heartbeat.rest();
    EXPECT_EQ(heartbeat.silentSeconds(later), 0.0);
}

/// Stderr is a pipe of which nobody reads.
class BlockedLog : public testing::Test {
  protected:
    void SetUp() override {
        ASSERT_EQ(::pipe2(ends, O_CLOEXEC), 0);
        before = ::dup(STDERR_FILENO);
        ::dup2(ends[1], STDERR_FILENO);
    }
    void TearDown() override {
        ::dup2(before, STDERR_FILENO);
        for (const int descriptor : {before, ends[0], ends[1]}) ::close(descriptor);
    }
    std::string readAll() const {
        std::string text(1U << 20U, '\0');
        ::fcntl(ends[0], F_SETFL, O_NONBLOCK);
        const ssize_t count = ::read(ends[0], text.data(), text.size());
        text.resize(count < 0 ? 0 : static_cast<std::size_t>(count));
        return text;
    }

    int ends[2] = {-1, -1}, before = -1;
};

TEST_F(BlockedLog, LosesLinesAndCountsThem) {
    Metrics metrics;
    EventLog log(metrics);
    for (int i = 0; i < 2000; ++i) log.event("info", "test", {{"text", std::string(500, 'x')}});
    const std::int64_t lost = valueOf(metrics, "log_lines_lost_total");
    EXPECT_GT(lost, 1000);
    readAll();
    log.event("info", "after", nullptr);
    const std::string text = readAll();
    const auto first = nlohmann::json::parse(text.substr(0, text.find('\n')));
    EXPECT_EQ(first.at("event"), "log_lines_lost");
    EXPECT_EQ(first.at("lines"), lost);
    EXPECT_NE(text.find("\"after\""), std::string::npos);
    EXPECT_EQ(valueOf(metrics, "log_lines_lost_total"), lost);
}

TEST_F(BlockedLog, LinesThatAreTooLongAreShortened) {
    Metrics metrics;
    EventLog log(metrics);
    log.event("info", "long", {{"text", std::string(100000, 'x')}, {"number", 7}});
    log.event("info", "longer", {{"text", std::string(100000, '\n')}, {"other", std::string(100000, '\n')}});
    std::istringstream lines(readAll());
    std::string line;
    std::getline(lines, line);
    EXPECT_EQ(nlohmann::json::parse(line).at("number"), 7);
    std::getline(lines, line);
    EXPECT_EQ(nlohmann::json::parse(line).at("event"), "longer");
    EXPECT_EQ(valueOf(metrics, "log_lines_lost_total"), 0);
}

}  // namespace
}  // namespace lumulus::service
