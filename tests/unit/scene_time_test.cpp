// Time and place, moon, exposure and tables of phase functions in scene files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "base/error.h"
#include "scene/load.h"
#include "support/temporary_folder.h"

namespace lumulus::scene {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string messageOf(const std::string& toml, const std::vector<std::string>& overrides = {}) {
    try {
        parseScene(toml, "x.toml", overrides);
    } catch (const InputError& e) {
        return e.what();
    }
    return "no error";
}

const std::string golden = "[time]\nutc = \"2003-10-17T19:30:30Z\"\nlatitude = 39.742476\nlongitude = -105.1786\n";

TEST(SceneTime, SetsSunAndMoon) {
    const Scene scene = parseScene(golden, "x.toml");
    EXPECT_LT(glm::length(scene.sun.directionTo - skyDirection(194.34, 39.872)), 2e-4);
    EXPECT_NE(scene.moon.directionTo, Moon{}.directionTo);
    EXPECT_GT(scene.moon.phaseAngle, 0.0);
    EXPECT_FALSE(scene.moon.shines);
}

TEST(SceneTime, MayBeWrittenWithoutQuotes) {
    const std::string place = "latitude = 39.742476\nlongitude = -105.1786\n";
    EXPECT_EQ(parseScene("[time]\nutc = 2003-10-17T19:30:30Z\n" + place, "x.toml").sun.directionTo,
              parseScene(golden, "x.toml").sun.directionTo);
    EXPECT_THAT(messageOf("[time]\nutc = 2003-10-17T19:30:30\n" + place), HasSubstr("utc must be a time"));
    EXPECT_THAT(messageOf("[time]\nutc = 2003-10-17T19:30:30+02:00\n" + place), HasSubstr("utc must be a time"));
}

TEST(SceneTime, NeedsAllThreeKeys) {
    EXPECT_THAT(messageOf("[time]\nlatitude = 3"), AllOf(HasSubstr("x.toml:2, time.latitude"), HasSubstr("time.utc")));
    EXPECT_THAT(messageOf("[time]\nutc = \"2003-10-17T19:30:30Z\"\nlatitude = 3"), HasSubstr("without time.longitude"));
}

TEST(SceneTime, RefusesOtherYearsAndNonsense) {
    const auto with = [](const std::string& utc) {
        return "[time]\nutc = \"" + utc + "\"\nlatitude = 0\nlongitude = 0\n";
    };
    EXPECT_THAT(messageOf(with("1949-12-31T23:59:59Z")),
                AllOf(HasSubstr("1949 is not from 1950 to 2050"), HasSubstr("x.toml:2, time.utc")));
    EXPECT_THAT(messageOf(with("2051-01-01T00:00:00Z")), HasSubstr("2051"));
    EXPECT_EQ(messageOf(with("1950-01-01T00:00:00Z")), "no error");
    EXPECT_EQ(messageOf(with("2050-12-31T23:59:59Z")), "no error");
    EXPECT_THAT(messageOf(with("noon")), AllOf(HasSubstr("utc must be a time as 2026-06-21T10:00:00Z, got \"noon\""),
                                               HasSubstr("x.toml:2, time.utc")));
    EXPECT_THAT(messageOf("[time]\nutc = \"2003-10-17T19:30:30Z\"\nlatitude = 91\nlongitude = 0"),
                AllOf(HasSubstr("x.toml:3, time.latitude"), HasSubstr("got 91")));
}

TEST(SceneTime, ExcludesDirections) {
    for (const char* key : {"azimuth = 3", "elevation = 3", "direction_to = [0, 1, 0]"})
        EXPECT_THAT(messageOf(golden + "[sun]\n" + key), AllOf(HasSubstr("exclude each other"), HasSubstr("time.")))
            << key;
    EXPECT_THAT(messageOf(golden + "[moon]\nphase_angle = 3"), HasSubstr("exclude each other"));
    // --set replaces what the file has, in both ways
    EXPECT_FALSE(parseScene(golden, "x.toml", std::vector<std::string>{"sun.elevation=10"}).time.has_value());
    const Scene scene =
        parseScene("[sun]\nelevation = 3", "x.toml",
                   std::vector<std::string>{"time.utc=2003-10-17T19:30:30Z", "time.latitude=0", "time.longitude=0"});
    EXPECT_TRUE(scene.time.has_value());
}

TEST(SceneMoon, StandsByItsAngles) {
    const Scene scene = parseScene("[moon]\nshines = true\nazimuth = 90\nelevation = 0\nphase_angle = 40", "x.toml");
    EXPECT_LT(glm::length(scene.moon.directionTo - glm::dvec3(1.0, 0.0, 0.0)), 1e-12);
    EXPECT_TRUE(scene.moon.shines);
    EXPECT_EQ(scene.moon.phaseAngle, 40.0);
}

TEST(SceneExposure, IsRead) {
    const Image image =
        parseScene("[image]\nexposure_mode = \"ev100\"\nev100 = 12\ntone_map = \"agx\"", "x.toml").image;
    EXPECT_EQ(image.exposureMode, ExposureMode::ev100);
    EXPECT_EQ(image.ev100, 12.0);
    EXPECT_EQ(image.toneMap, ToneMap::agx);
    EXPECT_THAT(messageOf("[image]\nev100 = nan"), HasSubstr("x.toml:2, image.ev100"));
    EXPECT_THAT(messageOf("[image]\nexposure_mode = \"bright\""), HasSubstr("x.toml:2, image.exposure_mode"));
}

class SceneTable : public testing::Test {
  protected:
    test::TemporaryFolder folder;
    std::string with(const std::string& text) {
        std::ofstream(folder / "p.txt") << text;
        return messageOf("[[cloud]]\nphase.model = \"table\"\nphase.table = \"" + (folder / "p.txt").string() + "\"");
    }
};

TEST_F(SceneTable, IsTakenWhereItIsWhole) {
    EXPECT_EQ(with("# angle value\n0, 100\n  90 1 # half\r\n\n180\t2\n"), "no error");
}

TEST_F(SceneTable, FaultsNameKeyLineAndTheLineOfTheFile) {
    EXPECT_THAT(with("0 1\n90 nan\n180 1"),
                AllOf(HasSubstr("p.txt:2"), HasSubstr("not finite"), HasSubstr("x.toml:3, cloud.0.phase.table")));
    EXPECT_THAT(with("0 1\n90 inf\n180 1"), HasSubstr("not finite"));
    EXPECT_THAT(with("0 1\n90 -1\n180 1"), AllOf(HasSubstr("p.txt:2"), HasSubstr("negative")));
    EXPECT_THAT(with("0 1\n90 1\n80 1\n180 1"), AllOf(HasSubstr("p.txt:3"), HasSubstr("not above the one before")));
    EXPECT_THAT(with("0 1\n90\n180 1"), AllOf(HasSubstr("p.txt:2"), HasSubstr("not an angle and a value")));
    EXPECT_THAT(with("0 1\n90 1 1\n180 1"), HasSubstr("not an angle and a value"));
    EXPECT_THAT(with("0 1\n90 1e40\n180 1"), HasSubstr("above 1e30"));
    EXPECT_THAT(with("0 1\n90 1"), HasSubstr("do not go from 0 to 180"));
    EXPECT_THAT(with(""), HasSubstr("do not go from 0 to 180"));
    EXPECT_THAT(with("0 0\n180 0"), HasSubstr("no value above 0"));
}

TEST_F(SceneTable, MissingFilesAreNamed) {
    const std::string head = "[[cloud]]\nphase.model = \"table\"\n";
    EXPECT_THAT(messageOf(head), AllOf(HasSubstr("needs a file"), HasSubstr("x.toml:2, cloud.0.phase.model")));
    EXPECT_THAT(messageOf(head + "phase.table = \"/nowhere.txt\""),
                AllOf(HasSubstr("/nowhere.txt: does not exist"), HasSubstr("x.toml:3, cloud.0.phase.table")));
    EXPECT_THAT(messageOf(head + "phase.table = \"" + folder.path().string() + "\""), HasSubstr("is a folder"));
    EXPECT_THAT(messageOf("[[cloud]]\nphase.table = \"p.txt\""), HasSubstr("has no effect"));
}

TEST(SceneMie, RadiusAndVarianceHaveRanges) {
    const std::string head = "[[cloud]]\nphase.model = \"mie\"\n";
    EXPECT_THAT(messageOf(head + "phase.effective_radius = 1.9"),
                AllOf(HasSubstr("x.toml:3, cloud.0.phase.effective_radius"), HasSubstr("2…50")));
    EXPECT_THAT(messageOf(head + "phase.effective_radius = 51"), HasSubstr("got 51"));
    EXPECT_THAT(messageOf(head + "phase.effective_variance = 0"),
                HasSubstr("x.toml:3, cloud.0.phase.effective_variance"));
    EXPECT_THAT(messageOf("[[cloud]]\nphase.effective_radius = 9"), HasSubstr("choose the model mie"));
}

}  // namespace
}  // namespace lumulus::scene
