#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/error.h"
#include "base/log.h"
#include "base/progress.h"

namespace lumulus {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::vector<std::string> shown(std::uint64_t total, std::uint64_t steps, bool terminal) {
    std::vector<std::string> lines;
    {
        Progress progress("photons", total, terminal, [&](const std::string& text) { lines.push_back(text); });
        for (std::uint64_t i = 0; i < steps; ++i) progress.advance();
    }
    return lines;
}

TEST(Progress, PipedShowsTheFirstAndTheLastLine) {
    const std::vector<std::string> lines = shown(1000, 1000, false);
    ASSERT_EQ(lines.size(), 2U);
    EXPECT_EQ(lines[0], "photons: 0/1000 (0 %)\n");
    EXPECT_THAT(lines[1], StartsWith("photons: 1000/1000 (100 %)"));
    for (const std::string& line : lines) EXPECT_EQ(line.find('\n'), line.size() - 1);
}

TEST(Progress, TerminalShowsABarAndEndsItsLine) {
    const std::vector<std::string> lines = shown(4, 4, true);
    ASSERT_GE(lines.size(), 3U);
    EXPECT_THAT(lines[0], StartsWith("\rphotons [          "));
    EXPECT_THAT(lines[lines.size() - 2], HasSubstr("[==============================] 4/4"));
    EXPECT_EQ(lines.back(), "\n");
}

TEST(Progress, StoppedEarlyEndsItsLine) {
    EXPECT_EQ(shown(10, 1, true).back(), "\n");
}

TEST(Progress, NothingToDoShowsNothing) {
    EXPECT_TRUE(shown(0, 0, true).empty());
    EXPECT_TRUE(shown(0, 0, false).empty());
}

TEST(Progress, QuietIsQuiet) {
    testing::internal::CaptureStderr();
    Progress progress("photons", 3, true);
    progress.advance(3);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(Progress, Durations) {
    EXPECT_EQ(durationText(0.04), "0.0 s");
    EXPECT_EQ(durationText(9.94), "9.9 s");
    EXPECT_EQ(durationText(9.96), "10 s");
    EXPECT_EQ(durationText(59.6), "1 min 00 s");
    EXPECT_EQ(durationText(185.0), "3 min 05 s");
    EXPECT_EQ(durationText(7620.0), "2 h 07 min");
}

TEST(Log, EverythingIsOneLine) {
    EXPECT_EQ(oneLine("a\nb\tc\r\n"), "a b c");
    EXPECT_EQ(oneLine("0…1, über"), "0…1, über");
    testing::internal::CaptureStderr();
    logError("bad\nname");
    logWarning("odd");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "lumulus: error: bad name\nlumulus: warning: odd\n");
}

TEST(ErrorText, PartsAndExitCodes) {
    EXPECT_STREQ(InputError("albedo must lie in 0…1", "x.toml:3", "mend it").what(),
                 "albedo must lie in 0…1 (x.toml:3): mend it");
    EXPECT_STREQ(Error("interrupted", "", "").what(), "interrupted");
    EXPECT_EQ(InputError("", "", "").exitCode(), 2);
    EXPECT_EQ(Error("", "", "").exitCode(), 1);
}

}  // namespace
}  // namespace lumulus
