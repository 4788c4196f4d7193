// Files whose clouds lie far apart: each part is a cloud of its own, and all of them are the density of the file.
#include "volume/far_parts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "unit/vdb_grids.h"
#include "vdb/load_sparse.h"
#include "volume/load.h"

namespace lumulus::test {
namespace {

using openvdb::Coord;

void addBall(openvdb::FloatGrid& grid, const Coord& middle, int radius, float value = 1.0F) {
    auto access = grid.getAccessor();
    for (int x = -radius; x <= radius; ++x)
        for (int y = -radius; y <= radius; ++y)
            for (int z = -radius; z <= radius; ++z)
                if (x * x + y * y + z * z <= radius * radius)
                    access.setValueOn(middle + Coord(x, y, z), value * static_cast<float>(1 + (x + y + z) % 2 * 0.25));
}

class FarParts : public GridFiles {
  protected:
    /// A scene of one cloud: balls of radius 12.
    scene::Scene sceneOf(const std::vector<Coord>& middles, const std::string& name = "grid.vdb") const {
        const openvdb::FloatGrid::Ptr grid = makeGrid();
        grid->setTransform(openvdb::math::Transform::createLinearTransform(5.0));
        for (const Coord& middle : middles) addBall(*grid, middle, 12, middle.x() > 0 ? 0.5F : 1.0F);
        std::ofstream out(file(name), std::ios::binary);
        openvdb::io::Stream(out).write(openvdb::GridCPtrVec{grid});
        return sceneOfFile(name);
    }

    scene::Scene sceneOfFile(const std::string& name) const {
        scene::Scene scene;
        scene.clouds.resize(1);
        scene.clouds[0].vdb = file(name);
        scene.clouds[0].name = "veil";
        scene.clouds[0].transform[3] = glm::dvec4(10.0, 20.0, 30.0, 1.0);
        return scene;
    }
};

TEST_F(FarParts, AreCloudsOfTheirOwn) {
    const std::vector<Coord> middles{Coord(-40, 3, 17), Coord(20000, 3003, -9), Coord(20011, -4000, 5)};
    const scene::Scene whole = sceneOf(middles), divided = divideFarParts(whole);
    ASSERT_EQ(divided.clouds.size(), 3U);
    const CloudVolumes parts = loadClouds(divided, noReport, stopIfInterrupted, FieldStorage::asWanted);
    EXPECT_FALSE(parts.isSparse());  // each fits
    EXPECT_TRUE(parts.warnings.empty());
    std::vector<bool> found(3, false);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(divided.clouds[i].name, "veil[" + std::to_string(i) + "]");
        EXPECT_EQ(divided.clouds[i].extinction, whole.clouds[0].extinction);
        const vdb::PlacedVolume part = parts.placed()[i];
        for (std::size_t k = 0; k < 3; ++k) {  // which of the three is it?
            const CloudVolumes alone = loadClouds(sceneOf({middles[k]}, "alone.vdb"));
            const vdb::PlacedVolume one = alone.placed()[0];
            if (glm::distance(part.toWorld.translation, one.toWorld.translation) > 1e-6) continue;
            EXPECT_EQ(part.volume->size, one.volume->size);
            EXPECT_EQ(part.volume->density, one.volume->density);
            EXPECT_EQ(part.toWorld.linear, one.toWorld.linear);
            found[k] = true;
        }
    }
    EXPECT_THAT(found, testing::Each(true));
}

TEST_F(FarParts, OfBricksHaveTheMassOfTheFile) {
    const scene::Scene whole = sceneOf({Coord(-40, 3, 17), Coord(20000, 3003, -9)});
    scene::Scene divided = divideFarParts(whole);
    ASSERT_EQ(divided.clouds.size(), 2U);
    divided.preparation.storage = scene::DensityStorage::sparse;
    const CloudVolumes parts = loadClouds(divided, noReport, stopIfInterrupted, FieldStorage::asWanted);
    ASSERT_TRUE(parts.isSparse());
    const auto massOf = [](const vdb::SparseVolume& volume) {
        double mass = 0.0;
        for (const vdb::LeafTable::Leaf& leaf : volume.leaves.leaves) mass += static_cast<double>(leaf.mass);
        return mass;
    };
    const double all = massOf(vdb::loadSparse(whole.clouds[0].vdb, {}).volume);
    EXPECT_NEAR(massOf(parts.bricks[0]) + massOf(parts.bricks[1]), all, 1e-6 * all);
    for (const vdb::SparseVolume& part : parts.bricks) {
        EXPECT_LE(part.size.x, 48);
        EXPECT_LE(part.size.y, 48);
        EXPECT_LE(part.size.z, 48);
    }
}

TEST_F(FarParts, IsLeftWhereOneBoxIsAsGood) {
    for (const scene::Scene& scene :
         {sceneOf({Coord(0, 0, 0)}, "one.vdb"), sceneOf({Coord(0, 0, 0), Coord(90, 0, 0)}, "near.vdb")})
        EXPECT_EQ(divideFarParts(scene), scene);
    scene::Scene twice = sceneOf({Coord(0, 0, 0), Coord(20000, 3003, -9)}, "twice.vdb");
    twice.clouds.push_back(twice.clouds[0]);
    EXPECT_EQ(divideFarParts(twice), twice);
}

/// What weighs next to nothing is left out by loading, with its warning.
TEST_F(FarParts, ASpeckIsNone) {
    const openvdb::FloatGrid::Ptr grid = makeGrid();
    addBall(*grid, Coord(0, 0, 0), 12);
    grid->getAccessor().setValueOn(Coord(9000, 9000, 9000), 1e-6F);
    save({grid});
    const scene::Scene scene = sceneOfFile("grid.vdb");
    EXPECT_EQ(divideFarParts(scene), scene);
}

TEST_F(FarParts, WhatCannotBeReadIsLeftToLoading) {
    std::ofstream(file("bad.vdb")) << "no grid";
    for (const char* name : {"bad.vdb", "missing.vdb"}) {
        const scene::Scene scene = sceneOfFile(name);
        EXPECT_EQ(divideFarParts(scene), scene);
        EXPECT_THROW(loadClouds(scene), InputError);
    }
}

}  // namespace
}  // namespace lumulus::test
