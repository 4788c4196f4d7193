// Names of the files of frames, and the frames of a range.
#include "base/frame_name.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "job/frame_range.h"

namespace lumulus::job {
namespace {

TEST(FrameNames, NumberInItsPlace) {
    EXPECT_EQ(nameOfFrame("a_####.exr", 7), "a_0007.exr");
    EXPECT_EQ(nameOfFrame("a_##.exr", 1007), "a_1007.exr");
    EXPECT_EQ(nameOfFrame("a.%04d.png", 12), "a.0012.png");
    EXPECT_EQ(nameOfFrame("a%d.png", 12), "a12.png");
    EXPECT_EQ(nameOfFrame("take#2_###.png", 5), "take#2_005.png");
    EXPECT_EQ(nameOfFrame("shots##/a_####.exr", 7), "shots##/a_0007.exr") << "folders keep their names";
    EXPECT_EQ(nameOfFrame("50%_%03d.exr", 7), "50%_007.exr");
    for (const char* name : {"a.exr", "50%.exr", "a%04x.exr", "##/a.exr"}) EXPECT_FALSE(hasFrameNumber(name)) << name;
}

TEST(FrameNames, Ranges) {
    EXPECT_EQ(parseFrames("3-9:3").numbers(), (std::vector<std::int64_t>{3, 6, 9}));
    EXPECT_EQ(parseFrames("1001").numbers(), (std::vector<std::int64_t>{1001}));
    EXPECT_EQ(parseFrames("0-1").numbers(), (std::vector<std::int64_t>{0, 1}));
    for (const char* text : {"", "a", "1-", "-1", "2-1", "1-2:0", "1-2:", "1-2:3x", "1 - 2", "0-1000000", "1000000000"})
        EXPECT_THROW(parseFrames(text), InputError) << text;
}

TEST(FrameNames, InWords) {
    EXPECT_EQ(inWords({3, 7, 8, 9, 12}), "3, 7-9, 12");
    EXPECT_EQ(inWords({}), "");
}

}  // namespace
}  // namespace lumulus::job
