// Which file of a sequence a cloud shows.
#include "scene/file_sequence.h"

#include <gtest/gtest.h>

namespace lumulus::scene {
namespace {

FileSequence from(std::int64_t first, std::int64_t last, Extend extend = Extend::hold) {
    FileSequence sequence;
    sequence.frames = glm::i64vec2(first, last);
    sequence.extend = extend;
    return sequence;
}

TEST(FileSequence, FramesHaveTheirNumbers) {
    EXPECT_EQ(fileAt({}, 17.0, 24.0), 17);
    EXPECT_EQ(fileAt(from(1001, 1240), 1001.0, 24.0), 1001);
    EXPECT_EQ(fileAt(from(1001, 1240), 1100.0, 24.0), 1100);
}

TEST(FileSequence, RateSpeedAndOffsetCountFromTheFirst) {
    FileSequence sequence = from(1001, 1240);
    sequence.fps = 12.0;
    EXPECT_EQ(fileAt(sequence, 1021.0, 24.0), 1011);
    sequence.speed = 4.0;
    EXPECT_EQ(fileAt(sequence, 1021.0, 24.0), 1041);
    sequence.offset = 5.0;
    EXPECT_EQ(fileAt(sequence, 1001.0, 24.0), 1006);
    sequence.speed = 0.0;
    EXPECT_EQ(fileAt(sequence, 1200.0, 24.0), 1006) << "stands still";
}

TEST(FileSequence, BeyondItsEnds) {
    const auto at = [](Extend extend, double frame) { return fileAt(from(10, 13, extend), frame, 24.0); };
    EXPECT_EQ(at(Extend::hold, 3.0), 10);
    EXPECT_EQ(at(Extend::hold, 99.0), 13);
    EXPECT_EQ(at(Extend::repeat, 14.0), 10);
    EXPECT_EQ(at(Extend::repeat, 9.0), 13);
    EXPECT_EQ(at(Extend::pingPong, 14.0), 12);
    EXPECT_EQ(at(Extend::pingPong, 16.0), 10);
    EXPECT_EQ(at(Extend::pingPong, 17.0), 11);
    EXPECT_EQ(at(Extend::pingPong, 8.0), 12);
    EXPECT_EQ(at(Extend::clip, 9.0), std::nullopt);
    EXPECT_EQ(at(Extend::clip, 13.0), 13);
    EXPECT_EQ(fileAt(from(7, 7, Extend::pingPong), 20.0, 24.0), 7);
}

}  // namespace
}  // namespace lumulus::scene
