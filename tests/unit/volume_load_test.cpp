#include "volume/load.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stat/ball.h"
#include "support/temporary_folder.h"
#include "vdb/procedural.h"
#include "vdb/transform.h"
#include "vdb/write.h"
#include "volume/known_fields.h"

namespace lumulus {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

scene::Cloud sphere(int resolution, double shift = 0.0) {
    scene::Cloud cloud;
    cloud.procedural = "sphere";
    cloud.resolution = resolution;
    cloud.transform[3].x = shift;
    return cloud;
}

scene::Cloud file(const std::filesystem::path& path) {
    scene::Cloud cloud;
    cloud.vdb = path;
    return cloud;
}

TEST(LoadClouds, EqualSourcesShareAField) {
    scene::Scene scene;
    scene.clouds = {sphere(16), sphere(20), sphere(16, 500.0)};
    scene.clouds[2].extinction = 3.0;
    scene.clouds[2].grid = "of no use to a procedural cloud";
    const CloudVolumes loaded = loadClouds(scene);
    ASSERT_EQ(loaded.volumes.size(), 2U);
    ASSERT_EQ(loaded.clouds.size(), 3U);
    EXPECT_EQ(loaded.clouds[0].volume, loaded.clouds[2].volume);
    EXPECT_NE(loaded.clouds[0].volume, loaded.clouds[1].volume);
    const glm::dvec3 moved = loaded.clouds[2].toWorld.translation - loaded.clouds[0].toWorld.translation;
    EXPECT_LT(glm::distance(moved, glm::dvec3(500.0, 0.0, 0.0)), 1e-9);
    EXPECT_EQ(loaded.placed()[2].volume, loaded.volumes[loaded.clouds[0].volume].get());
}

TEST(LoadClouds, OneCloudIsTheSameAlone) {
    scene::Scene scene;
    scene.clouds = {sphere(16, 7.0)};
    scene.clouds[0].transform[0] = {0.3, 0.1, 0.0, 0.0};
    const CloudVolumes loaded = loadClouds(scene);
    const vdb::Volume alone = vdb::makeCloud({"sphere", 16, scene.clouds[0].seed});
    const vdb::Affine place = vdb::composeTransforms(scene.clouds[0].transform, alone.toWorld, "transform");
    EXPECT_EQ(loaded.volumes[0]->density, alone.density);
    EXPECT_EQ(loaded.clouds[0].toWorld.linear, place.linear);
    EXPECT_EQ(loaded.clouds[0].toWorld.translation, place.translation);
}

TEST(LoadClouds, ShareTheMemoryBudget) {
    const test::TemporaryFolder folder;
    vdb::write(boxVolume(glm::ivec3(64)), folder / "a.vdb");  // 0.55 MiB each
    vdb::write(boxVolume(glm::ivec3(64)), folder / "b.vdb");
    vdb::write(boxVolume(glm::ivec3(18)), folder / "small.vdb");  // 0.02 MiB
    scene::Scene scene;
    scene.clouds = {file(folder / "a.vdb"), file(folder / "small.vdb"), file(folder / "b.vdb")};
    scene.preparation.memoryBudget = 4.0;
    EXPECT_TRUE(loadClouds(scene).warnings.empty());
    scene.preparation.memoryBudget = 1.0;
    const CloudVolumes loaded = loadClouds(scene);
    ASSERT_EQ(loaded.warnings.size(), 2U);
    EXPECT_THAT(loaded.warnings[0], StartsWith("cloud.0: "));
    EXPECT_THAT(loaded.warnings[1], StartsWith("cloud.2: "));
    EXPECT_EQ(loaded.volumes[1]->size, glm::ivec3(20)) << "needs less than its share";
    double mebibytes = 0.0;
    for (const auto& volume : loaded.volumes)
        mebibytes += static_cast<double>(volume->density.size()) * 2.0 / 1048576.0;
    EXPECT_LE(mebibytes, 1.0);
    EXPECT_EQ(loaded.volumes[0]->size, loaded.volumes[2]->size);
    EXPECT_LT(loaded.volumes[0]->size.x, 66);
}

/// A scene of a sequence takes the fields that the one before has too, wherever they lie, and holds no others.
TEST(LoadClouds, TakesFieldsThatAreKnown) {
    const test::TemporaryFolder folder;
    vdb::write(boxVolume(glm::ivec3(40)), folder / "a.vdb");
    vdb::write(boxVolume(glm::ivec3(30)), folder / "b.vdb");
    scene::Scene scene;
    scene.clouds = {file(folder / "a.vdb"), sphere(16)};
    scene.preparation.memoryBudget = 4.0;
    KnownFields known;
    const auto load = [&] { return loadClouds(scene, noReport, stopIfInterrupted, FieldStorage::dense, &known); };
    const CloudVolumes first = load();
    ASSERT_EQ(known.fields.size(), 2U);
    scene.clouds[0].transform[3] = {100.0, 0.0, 0.0, 1.0};
    scene.clouds[1].extinction = 0.5;
    const CloudVolumes moved = load(), alone = loadClouds(scene);
    EXPECT_EQ(moved.volumes, first.volumes);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(moved.volumes[i]->density, alone.volumes[i]->density);
        EXPECT_EQ(moved.clouds[i].toWorld.translation, alone.clouds[i].toWorld.translation);
        EXPECT_EQ(moved.clouds[i].thickness.largest, alone.clouds[i].thickness.largest);
    }
    EXPECT_EQ(moved.warnings, alone.warnings);
    scene.clouds[0].vdb = folder / "b.vdb";
    const CloudVolumes other = load();
    EXPECT_NE(other.volumes[0], first.volumes[0]);
    EXPECT_EQ(other.volumes[1], first.volumes[1]);
    EXPECT_EQ(known.fields.size(), 2U);
    scene.preparation.memoryBudget = 3.0;
    EXPECT_NE(load().volumes[0], other.volumes[0]) << "within another budget it may be another";
    scene.clouds[1].resolution = 20;
    EXPECT_NE(load().volumes[1], other.volumes[1]);
}

}  // namespace
}  // namespace lumulus
