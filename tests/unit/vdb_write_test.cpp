#include "vdb/write.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <string>

#include "base/error.h"
#include "support/temporary_folder.h"
#include "vdb/describe.h"
#include "vdb/load.h"
#include "vdb/procedural.h"

namespace lumulus::vdb {
namespace {

class Write : public ::testing::Test {
  protected:
    std::filesystem::path file() const { return folder_ / "cloud.vdb"; }

    test::TemporaryFolder folder_;
};

/// A volume whose values reach the ring on all sides, so that nothing is cropped.
Volume fullBox() {
    Volume volume;
    volume.size = {5, 7, 12};
    volume.density.assign(volume.index(0, 0, 12), 0.0F);
    for (int z = 1; z < 11; ++z) {
        for (int y = 1; y < 6; ++y) {
            for (int x = 1; x < 4; ++x)
                volume.density[volume.index(x, y, z)] = static_cast<float>(x + 10 * y + 100 * z);
        }
    }
    volume.maximum = 1053.0F;
    volume.toWorld.linear = glm::dmat3(2.0, 0.1, 0.0, 0.3, 3.0, 0.0, 0.0, 0.5, 4.0);
    volume.toWorld.translation = {1e6, -20.0, 3.0};
    return volume;
}

TEST_F(Write, WhatWasWrittenIsLoaded) {
    const Volume volume = fullBox();
    write(volume, file());
    const LoadResult result = load(file(), {});
    EXPECT_TRUE(result.warnings.empty());
    EXPECT_EQ(folder_.files(), 1U);
    EXPECT_EQ(result.volume.size, volume.size);
    EXPECT_EQ(result.volume.density, volume.density);
    EXPECT_EQ(result.volume.maximum, volume.maximum);
    for (const glm::dvec3 corner : {glm::dvec3(0), glm::dvec3(5, 0, 0), glm::dvec3(0, 7, 12)}) {
        EXPECT_NEAR(glm::distance(result.volume.toWorld.point(corner), volume.toWorld.point(corner)), 0.0, 1e-8);
    }
}

TEST_F(Write, IsAnOrdinaryFogVolume) {
    write(makeCloud({"sphere", 16, 1}), file());
    const auto infos = describe(file());
    ASSERT_EQ(infos.size(), 1U);
    EXPECT_EQ(infos[0].name, "density");
    EXPECT_EQ(infos[0].type, "float");
    EXPECT_EQ(infos[0].gridClass, "fog volume");
    EXPECT_NEAR(infos[0].voxelSize.x, 200.0 / 14, 1e-9);
    EXPECT_EQ(infos[0].activeMinimum, glm::ivec3(1));
    EXPECT_EQ(infos[0].values->background, 0.0);
}

TEST_F(Write, SameVolumeSameBytes) {
    const auto bytesOf = [&](int resolution) {
        write(makeCloud({"sphere", resolution, 1}), file());
        return test::readAll(file());
    };
    const std::string bytes = bytesOf(16);
    EXPECT_EQ(bytesOf(16), bytes);
    const std::string uuid = bytes.substr(21, 36);
    EXPECT_TRUE(
        std::regex_match(uuid, std::regex("[0-9a-f]{8}-[0-9a-f]{4}-8[0-9a-f]{3}-[89ab][0-9a-f]{3}-[0-9a-f]{12}")))
        << uuid;
    EXPECT_NE(bytesOf(17).substr(21, 36), uuid);
}

TEST_F(Write, EmptyVolume) {
    Volume volume;
    volume.size = {3, 3, 3};
    volume.density.assign(27, 0.0F);
    write(volume, file());
    EXPECT_TRUE(load(file(), {}).volume.empty());
}

TEST_F(Write, DiskFull) {
    ASSERT_TRUE(std::filesystem::exists("/dev/full"));
    try {
        write(fullBox(), "/dev/full");
        FAIL() << "a full disk went unnoticed";
    } catch (const Error& error) {
        EXPECT_EQ(error.exitCode(), 1) << error.what();
    }
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
}

TEST_F(Write, FolderThatIsNotThere) {
    EXPECT_THROW(write(fullBox(), folder_ / "absent/cloud.vdb"), InputError);
    EXPECT_EQ(folder_.files(), 0U);
}

}  // namespace
}  // namespace lumulus::vdb
