// Scenes whose keys change from frame to frame.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "scene/animation.h"
#include "scene/load.h"

namespace lumulus::scene {
namespace {

using glm::dvec3;

Scene at(double frame, const std::string& animate) {
    return parseScene("[animate]\n" + animate, "x.toml", {}, std::nullopt, {}, frame);
}

double elevation(const Scene& scene) {
    return glm::degrees(std::asin(scene.sun.directionTo.y));
}

TEST(Animation, LinearBetweenKeysAndStillOutside) {
    const std::string text = "\"sun.elevation\" = [[10, 5.0], [20, 40.0], [30, 10.0]]";
    for (const auto& [frame, wanted] :
         {std::pair{0.0, 5.0}, {10.0, 5.0}, {12.0, 12.0}, {20.0, 40.0}, {25.0, 25.0}, {30.0, 10.0}, {1e6, 10.0}})
        EXPECT_NEAR(elevation(at(frame, text)), wanted, 1e-9) << frame;
}

TEST(Animation, SmoothStepAndSpline) {
    const auto text = [](const char* how) {
        return std::string("\"sun.elevation\" = { keys = [[0, 0], [4, 20], [8, 0]], interpolation = \"") + how + "\" }";
    };
    EXPECT_NEAR(elevation(at(1, text("smooth"))), 20.0 * (3.0 / 16.0 - 2.0 / 64.0), 1e-9);
    EXPECT_NEAR(elevation(at(3.9, text("step"))), 0.0, 1e-9);
    EXPECT_NEAR(elevation(at(4, text("step"))), 20.0, 1e-9);
    // slopes 5 a frame at the first key and 0 at the second: cubic Hermite with u = 1/4
    const double u = 0.25, spline = 20.0 * (3.0 * u * u - 2.0 * u * u * u) + 20.0 * (u * u * u - 2.0 * u * u + u);
    EXPECT_NEAR(elevation(at(1, text("spline"))), spline, 1e-9);
    EXPECT_NEAR(elevation(at(4, text("spline"))), 20.0, 1e-9);
}

TEST(Animation, SecondsAreFramesOfTheRate) {
    EXPECT_NEAR(elevation(at(15, "fps = 10\n\"sun.elevation\" = { keys = [[0, 0], [3, 30]], unit = \"second\" }")),
                15.0, 1e-9);
    EXPECT_NEAR(elevation(at(12, "\"sun.elevation\" = { keys = [[0, 0], [1, 30]], unit = \"second\" }")), 15.0, 1e-9)
        << "24 frames a second by default";
}

TEST(Animation, VectorsMatricesTextAndWholeNumbers) {
    const Scene scene =
        at(5,
           "camera.position = [[0, [0, 10, 100]], [10, [20, 30, 50]]]\n"
           "cloud.0.transform = [[0, [[1,0,0,0],[0,1,0,0],[0,0,1,0]]], [10, [[2,0,0,4],[0,1,0,0],[0,0,1,0]]]]\n"
           "cloud.0.seed = [[0, 1], [10, 4]]\n"
           "cloud.0.procedural = [[0, \"cumulus\"], [5, \"stratus\"]]\n"
           "image.background = [[0, true], [6, false]]");
    EXPECT_EQ(scene.camera.position, dvec3(10, 20, 75));
    EXPECT_EQ(scene.clouds.at(0).transform[0][0], 1.5);
    EXPECT_EQ(scene.clouds.at(0).transform[3][0], 2.0);
    EXPECT_EQ(scene.clouds.at(0).seed, 2u) << "a half goes to the even number";
    EXPECT_EQ(scene.clouds.at(0).procedural, "stratus");
    EXPECT_TRUE(scene.image.background);
}

TEST(Animation, OverridesStandAbove) {
    const std::vector<std::string> overrides{"sun.elevation=50"};
    const Scene scene =
        parseScene("[animate]\n\"sun.elevation\" = [[0, 1], [9, 2]]", "x.toml", overrides, std::nullopt, {}, 3.0);
    EXPECT_NEAR(elevation(scene), 50.0, 1e-9);
}

TEST(Animation, TheAnimationStandsAboveTheFile) {
    const Scene scene = parseScene("sun = { elevation = 7 }\n[animate]\n\"sun.elevation\" = [[0, 1], [9, 2]]", "x.toml",
                                   {}, std::nullopt, {}, 9.0);
    EXPECT_NEAR(elevation(scene), 2.0, 1e-9);
}

TEST(Animation, ErrorsNameTheLineAndTheFrame) {
    const auto message = [](const std::string& text, double frame = 0.0) {
        try {
            at(frame, text);
        } catch (const InputError& e) {
            return std::string(e.what());
        }
        return std::string("accepted");
    };
    EXPECT_THAT(message("\n\"sun.hight\" = [[0, 1]]"),
                testing::AllOf(testing::HasSubstr("x.toml:3"), testing::HasSubstr("hight")));
    EXPECT_THAT(message("\"sun.elevation\" = [[0, 1], [10, 100]]", 10),
                testing::AllOf(testing::HasSubstr("frame 10"), testing::HasSubstr("x.toml:2")));
    EXPECT_THAT(message("\"sun.elevation\" = [[0, 1], [0, 2]]"), testing::HasSubstr("rise"));
    EXPECT_THAT(message("\"sun.elevation\" = [[0, [1, 2]], [5, 2]]"), testing::HasSubstr("one form"));
}

}  // namespace
}  // namespace lumulus::scene
