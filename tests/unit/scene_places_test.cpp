#include "scene/places.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <sstream>

#include "base/error.h"
#include "scene/load.h"
#include "support/temporary_folder.h"

namespace lumulus::scene {
namespace {

using testing::AllOf;
using testing::HasSubstr;

Places read(const std::string& text, std::size_t most = 100) {
    std::istringstream file(text);
    return readPlaces(file, "places.csv", most);
}

std::string messageOf(const std::string& text) {
    try {
        read(text);
    } catch (const InputError& e) {
        return e.what();
    }
    return "no error";
}

TEST(Places, ReadsAllColumnsAndFewer) {
    const Places all = read("x,y,z,yaw,scale,extinction\n1,2,3,90,0.5,2\r\n\n -1e3 , +4.5,6,-45,2,0\n");
    ASSERT_EQ(all.rows.size(), 2U);
    EXPECT_EQ(all.rows[0], (Place{{1, 2, 3}, 90, 0.5, 2}));
    EXPECT_EQ(all.rows[1], (Place{{-1000, 4.5, 6}, -45, 2, 0}));
    EXPECT_EQ(read("\xEF\xBB\xBFx,y,z\n1e7,-1e7,3").rows.at(0), (Place{{1e7, -1e7, 3}, 0, 1, 1}));
    EXPECT_EQ(read("x,y,z,yaw\n1,2,3,4\n").rows.at(0), (Place{{1, 2, 3}, 4, 1, 1}));
}

TEST(Places, KeepsNoMoreThanAsked) {
    std::string text = "x,y,z\n";
    for (int i = 0; i < 1000; ++i) text += "1,2,3\n";
    const Places places = read(text, 7);
    EXPECT_EQ(places.rows.size(), 7U);
    EXPECT_EQ(places.count, 1000U);
}

TEST(Places, ATurnIsClockwiseSeenFromAbove) {
    const Place place{{10, 20, 30}, 90, 2, 1};
    const glm::dvec4 north(0, 0, -1, 1), up(0, 1, 0, 1);  // 0° is towards −Z and 90° towards +X, as the sun's azimuth
    EXPECT_LT(glm::distance(place.transform() * north, glm::dvec4(12, 20, 30, 1)), 1e-12);
    EXPECT_LT(glm::distance(place.transform() * up, glm::dvec4(10, 22, 30, 1)), 1e-12);
}

TEST(Places, BadRowsNameFileLineAndColumn) {
    const std::string head = "x,y,z,yaw,scale,extinction\n1,2,3,0,1,1\n";
    EXPECT_THAT(messageOf(head + "1,2,nan,0,1,1"), AllOf(HasSubstr("z is nan"), HasSubstr("(places.csv:3, z)")));
    EXPECT_THAT(messageOf(head + "1,inf,3,0,1,1"), HasSubstr("(places.csv:3, y)"));
    EXPECT_THAT(messageOf(head + "1e400,2,3,0,1,1"), HasSubstr("(places.csv:3, x)"));
    EXPECT_THAT(messageOf(head + "1.1e7,2,3,0,1,1"), HasSubstr("from -1e+07 to 1e+07"));
    EXPECT_THAT(messageOf(head + "\n1,2,3,0,0,1"),
                AllOf(HasSubstr("scale is 0 (places.csv:4, scale)"), HasSubstr("give a number above 0")));
    EXPECT_THAT(messageOf(head + "1,2,3,0,-1,1"), HasSubstr("scale is -1"));
    EXPECT_THAT(messageOf(head + "1,2,3,0,1,-0.5"), HasSubstr("extinction is -0.5"));
    EXPECT_THAT(messageOf(head + "1,2,3,0,1,"), HasSubstr("\"\" is no number"));
    EXPECT_THAT(messageOf(head + "1,2,3,0,1m,1"), HasSubstr("\"1m\" is no number"));
    EXPECT_THAT(messageOf(head + "1,2,3"), HasSubstr("the row has 3 columns, the first line 6 (places.csv:3)"));
    EXPECT_THAT(messageOf(head + "1,2,3,0,1,1,1,1,1"), HasSubstr("more than 6 columns"));
    EXPECT_THAT(messageOf(head + std::string(5000, '1')), HasSubstr("longer than 4096 bytes"));
}

TEST(Places, BadHeadersSayHowTheyAreWritten) {
    for (const char* text : {"1,2,3\n", "x,y\n1,2\n", "x,z,y\n1,2,3\n", "x,y,z,scale\n1,2,3,1\n", "", "\n\n"})
        EXPECT_THAT(messageOf(text), HasSubstr("x,y,z,yaw,scale,extinction")) << text;
    EXPECT_THAT(messageOf("x,y,z\n"), HasSubstr("the file has no places (places.csv)"));
}

TEST(Places, WhatIsNoFileIsNotWaitedFor) {
    const test::TemporaryFolder folder;
    const std::filesystem::path pipe = folder / "pipe.csv", large = folder / "large.csv";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_THROW(readPlaces(pipe, 10), InputError);
    EXPECT_THROW(readPlaces(folder / "none.csv", 10), InputError);
    test::writeAll(large, "x,y,z\n");
    std::filesystem::resize_file(large, std::uintmax_t{257} << 20);
    EXPECT_THROW(readPlaces(large, 10), InputError);
}

TEST(Places, PathsAreThoseOfTheScene) {
    const test::TemporaryFolder folder;
    test::writeAll(folder / "places.csv", "x,y,z\n1,2,3\n");
    const std::string scene = "[[cloud]]\ninstances = \"places.csv\"\n";
    const std::string name = (folder / "scene.toml").string();
    EXPECT_EQ(parseScene(scene, name).clouds.at(0).instances, folder / "places.csv");
    EXPECT_THROW(parseScene("[[cloud]]\ninstances = \"none.csv\"\n", name), InputError);
    EXPECT_THROW(parseScene("[[cloud]]\ninstances = \".\"\n", name), InputError);
    const std::vector<std::filesystem::path> elsewhere{folder / "elsewhere"}, here{folder / "."};
    EXPECT_THROW(parseScene(scene, name, {}, {}, elsewhere), InputError);
    EXPECT_NO_THROW(parseScene(scene, name, {}, {}, here));
}

}  // namespace
}  // namespace lumulus::scene
