// Points of another renderer: the table goes in as error.csv comes out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "base/error.h"
#include "bench/peer.h"
#include "bench/plot.h"
#include "bench/table.h"

namespace lumulus::bench {
namespace {

using testing::HasSubstr;
using testing::Not;

Row cyclesRow(double seconds, double relMse) {
    Row row;
    row.method = Method::cycles;
    row.budget = 4.0;
    row.seeds = 2;
    row.seconds = {seconds + 2.0, 0.5};
    row.warmSeconds = {seconds, 0.25};
    row.amount = {16.0, 0.0};
    row.relMse = {relMse, 0.125};
    row.relativeBias = {-0.5, 0.25};
    return row;
}

std::string refusal(const std::string& text) {
    try {
        parsePeer(text, "x.csv");
    } catch (const InputError& e) {
        return e.what();
    }
    return "";
}

TEST(Peer, ReadsWhatCsvWrites) {
    const std::vector<Row> rows{cyclesRow(1.0, 4.0), cyclesRow(8.0, 0.5)};
    const std::vector<Row> read = parsePeer(csv(rows), "x.csv");
    ASSERT_EQ(read.size(), 2U);
    EXPECT_EQ(read[0].method, Method::cycles);
    EXPECT_EQ(read[0].seeds, 2U);
    EXPECT_EQ(csv(read), csv(rows));
}

TEST(Peer, NamesTheLineOfWhatIsWrong) {
    const std::string good = csv(std::vector<Row>{cyclesRow(1.0, 4.0)});
    EXPECT_EQ(refusal(good), "");
    EXPECT_THAT(refusal(""), HasSubstr("(x.csv:1)"));
    EXPECT_THAT(refusal("a,b\n"), HasSubstr("the columns are not those of error.csv (x.csv:1)"));
    EXPECT_THAT(refusal(good + "Cycles,1\n"), HasSubstr("2 values (x.csv:3)"));
    std::string other = good;
    other.replace(other.find("Cycles"), 6, "render");
    EXPECT_THAT(refusal(other), HasSubstr("the method \"render\" (x.csv:2)"));
    for (const char* bad : {"nan", "1e400", "", "4x"}) {
        std::string text = good;
        text.replace(text.find("4,0.125"), 1, bad);
        EXPECT_THAT(refusal(text), HasSubstr("is no number (x.csv:2)")) << bad;
    }
    Row still = cyclesRow(0.0, 1.0);
    EXPECT_THAT(refusal(csv(std::vector<Row>{still})), HasSubstr("not above 0 (x.csv:2)"));
}

/// 4 at 1 s, 1/samples: .01 after 400 s, and as much as it takes before the first sample by the other clock.
TEST(Peer, IsInTheTableAndInThePlot) {
    Row render;
    render.seconds = render.warmSeconds = {2.0, 0.0};
    render.relMse = {0.01, 0.0};
    const std::vector<Row> rows{render, cyclesRow(1.0, 4.0)};
    const std::string table = tableText(rows, std::nullopt);
    EXPECT_THAT(table, HasSubstr("Cycles     ratio\n"));
    EXPECT_THAT(table, HasSubstr("~400 s"));
    EXPECT_THAT(table, HasSubstr("~402 s"));
    EXPECT_THAT(tableText(std::span(rows).first(1), std::nullopt), Not(HasSubstr("Cycles")));
    EXPECT_NE(errorPlot(rows, "", std::nullopt).png, errorPlot(std::span(rows).first(1), "", std::nullopt).png);
}

}  // namespace
}  // namespace lumulus::bench
