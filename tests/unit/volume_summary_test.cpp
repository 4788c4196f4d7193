// What is told of clouds before they are drawn.
#include "volume/summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/scene.h"
#include "stat/ball.h"
#include "support/temporary_folder.h"
#include "vdb/write.h"
#include "volume/load.h"

namespace lumulus {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A scene with a box of 20 × 30 × 40 m of density 1.
scene::Scene boxScene(const test::TemporaryFolder& folder, double extinction) {
    vdb::write(boxVolume({20, 30, 40}), folder / "box.vdb");
    scene::Scene scene;
    scene.clouds.resize(1);
    scene.clouds[0].vdb = folder / "box.vdb";
    scene.clouds[0].extinction = extinction;
    return scene;
}

TEST(CloudSummary, OpticalThicknessOfABox) {
    const test::TemporaryFolder folder;
    scene::Scene scene = boxScene(folder, 0.1);
    scene.clouds[0].densityScale = 2.0;
    scene.clouds[0].transform = glm::dmat4(3.0);
    scene.clouds[0].transform[3][3] = 1.0;
    const CloudVolumes loaded = loadClouds(scene);
    const auto summary = summarise(scene, loaded).at(0);
    EXPECT_EQ(summary.grid, "density");
    EXPECT_EQ(summary.name, "0");
    EXPECT_NEAR(summary.largestThickness, 0.2 * 3 * 40, 1e-9);
    EXPECT_NEAR(summary.meanThickness, 0.2 * 3 * 30, 1e-9);
    EXPECT_THAT(loaded.warnings, IsEmpty());
    EXPECT_THAT(lineOf(summary), AllOf(HasSubstr("grid \"density\""), HasSubstr("at most 24"), HasSubstr("box.vdb")));
}

TEST(CloudSummary, OpticalThicknessOfABall) {
    const vdb::Volume ball = ballVolume(50, 10.0);
    const auto thickness = vdb::opticalThickness(vdb::columnSums(ball), ball.toWorld, 0.5);
    EXPECT_NEAR(thickness.largestOfAll(), 0.5 * 20.0, 0.05);
    // a chord of parallel rays is 4/3 of the radius on average; columns at the rim are cut
    EXPECT_NEAR(thickness.meanOfAll(), 0.5 * 40.0 / 3.0, 0.3);
}

TEST(CloudSummary, WarnsOfWhatWillNotBeSeenAndOfWalls) {
    const test::TemporaryFolder folder;
    for (const auto& [extinction, word] :
         {std::pair{3.2e-4, "raise"}, {3.5e-4, ""}, {24.9, ""}, {25.1, "lower"}, {1e6, "lower"}, {0.0, ""}}) {
        const auto warnings = loadClouds(boxScene(folder, extinction)).warnings;
        if (*word == '\0') {
            EXPECT_THAT(warnings, IsEmpty()) << extinction;
        } else {
            EXPECT_THAT(warnings, ElementsAre(AllOf(HasSubstr(word), HasSubstr("cloud.0.density_scale"),
                                                    HasSubstr("cloud.0.extinction"), HasSubstr("cloud.0.transform"))))
                << extinction;
        }
    }
}

TEST(CloudSummary, WarnsOfInstancesOfACloudOnce) {
    const std::vector<CloudSummary> clouds{{"veil[0]", "", "cirrus", 2000.0, 900.0},
                                           {"veil[1]", "", "cirrus", 3000.0, 900.0},
                                           {"other", "", "cirrus", 3000.0, 900.0}};
    EXPECT_THAT(warningsOf(clouds),
                ElementsAre(AllOf(HasSubstr("of cloud.veil[0] is"), HasSubstr("cloud.veil.extinction")),
                            HasSubstr("cloud.other.extinction")));
}

TEST(CloudSummary, NamesOfGrids) {
    EXPECT_EQ(gridNames(std::vector<CloudSummary>{{"0", "a.vdb", "smoke"}}), "smoke");
    EXPECT_EQ(gridNames(std::vector<CloudSummary>{{"0", "a.vdb", "smoke"}, {"veil", "", "cirrus"}}),
              "cloud.0: smoke, cloud.veil: cirrus");
}

TEST(CloudSummary, ClampIsPartOfTheSource) {
    const test::TemporaryFolder folder;
    scene::Scene scene = boxScene(folder, 0.1);
    scene.clouds.push_back(scene.clouds[0]);
    scene.clouds[1].clamp = true;
    EXPECT_EQ(loadClouds(scene).volumes.size(), 2U);
}

}  // namespace
}  // namespace lumulus
