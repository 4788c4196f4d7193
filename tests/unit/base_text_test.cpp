#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/error.h"
#include "base/log.h"
#include "base/progress.h"
#include "base/text.h"

namespace lumulus {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::MatchesRegex;
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

TEST(Progress, WorkOfOneStepShowsItsTime) {
    EXPECT_THAT(shown(1, 1, false), ElementsAre("photons: 0.0 s\n"));
    EXPECT_THAT(shown(1, 0, false), IsEmpty());
    EXPECT_THAT(shown(1, 1, true), ElementsAre("\rphotons …\033[K", "\rphotons: 0.0 s\033[K", "\n"));
    EXPECT_THAT(shown(1, 0, true), ElementsAre("\rphotons …\033[K", "\n"));
}

TEST(Progress, StepsFollowOneAnother) {
    testing::internal::CaptureStderr();
    {
        Steps steps(false);
        const Report report = steps.reporter();
        report("load", 0, 1);
        report("load", 1, 1);
        for (const std::uint64_t done : {0U, 3U, 2U, 5U}) report("draw", done, 5);
        Steps(true).report("quiet", 0, 5);
    }
    EXPECT_THAT(testing::internal::GetCapturedStderr(),
                MatchesRegex("load: 0.0 s\ndraw: 0/5 .0 %.\ndraw: 5/5 .100 %., [^\n]*\n"));
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

TEST(Text, OneLine) {
    EXPECT_EQ(oneLine("a\nb\tc\r\n"), "a b c");
    EXPECT_EQ(oneLine("0…1, über, 𝄞"), "0…1, über, 𝄞");
    EXPECT_EQ(oneLine("\x1b[31mred\x7f"), "\\x1B[31mred\\x7F");
    EXPECT_EQ(oneLine(std::string_view("a\0b", 3)), "a\\x00b");
    EXPECT_EQ(oneLine("\xc2\x9b"
                      "2J"),
              "\\xC2\\x9B"
              "2J")
        << "U+009B is a control character too";
    // overlong, a surrogate, beyond Unicode, a lone byte, a character cut off
    EXPECT_EQ(oneLine("\xc0\xaf"), "\\xC0\\xAF");
    EXPECT_EQ(oneLine("\xed\xa0\x80"), "\\xED\\xA0\\x80");
    EXPECT_EQ(oneLine("\xf4\x90\x80\x80"), "\\xF4\\x90\\x80\\x80");
    EXPECT_EQ(oneLine("\xff!"), "\\xFF!");
    EXPECT_EQ(oneLine("\xe2\x80"), "\\xE2\\x80");
}

TEST(Text, Shortened) {
    EXPECT_EQ(shortened("short", 5), "short");
    EXPECT_EQ(shortened("0123456789", 4), "01 … 6 bytes … 89");
    EXPECT_EQ(shortened("éééééééé", 6), "é … 12 bytes … é") << "characters stay whole";
    EXPECT_EQ(shortened("éé", 0), " … 4 bytes … ");
}

TEST(Log, EverythingIsOneLine) {
    testing::internal::CaptureStderr();
    logError("bad\nname");
    logWarning("odd");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "lumulus: error: bad name\nlumulus: warning: odd\n");
    testing::internal::CaptureStderr();
    logError("begin" + std::string(1000000, '\x1b') + "end");
    const std::string line = testing::internal::GetCapturedStderr();
    EXPECT_LT(line.size(), 1000U);
    EXPECT_THAT(line, AllOf(StartsWith("lumulus: error: begin\\x1B"), EndsWith("\\x1Bend\n")));
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
