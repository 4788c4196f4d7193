#include <gmock/gmock.h>
#include <openvdb/io/File.h>

#include <atomic>
#include <stdexcept>

#include "vdb/load_sparse.h"
#include "vdb_grids.h"

/// How much of a file is read, and what ends that.
namespace lumulus::test {
namespace {

using openvdb::Coord;
using ::testing::HasSubstr;

/// What a check throws here.
struct Stop : std::runtime_error {
    using std::runtime_error::runtime_error;
};

class Reading : public GridFiles {
  protected:
    /// A file that tells where its grids lie.
    std::filesystem::path saveFile(const openvdb::GridCPtrVec& grids) const {
        openvdb::io::File out(file().string());
        out.write(grids);
        return file();
    }

    /// Questions that a load asks.
    static int questions(const std::filesystem::path& path, const std::string& grid = "") {
        std::atomic<int> asked = 0;
        vdb::LoadOptions options;
        options.grid = grid;
        options.limits.check = [&] { ++asked; };
        vdb::load(path, options);
        return asked;
    }
};

/// Corner of box `i`, of an edge of `edge` voxels, where `across` boxes make a row and `across` rows a slice.
Coord placeOf(int i, int across, int edge) {
    return {i % across * edge, i / across % across * edge, i / across / across * edge};
}

/// A grid of `leaves` leaves, one voxel in each.
openvdb::FloatGrid::Ptr makeLeaves(const std::string& name, int leaves) {
    const openvdb::FloatGrid::Ptr grid = makeGrid(0.0F, name);
    auto accessor = grid->getAccessor();
    constexpr int edge = 8, across = 32;
    for (int i = 0; i < leaves; ++i) accessor.setValue(placeOf(i, across, edge), 1.0F);
    return grid;
}

TEST_F(Reading, OtherGridsAreSkipped) {
    const auto density = makeBlob(Coord(0));
    const int alone = questions(saveFile({density}));
    const auto heavy = makeLeaves("flame", 10000);
    saveFile({heavy, density, makeLeaves("heat", 2000)});
    EXPECT_LT(questions(file()), alone + 200);  // names, types and transforms of two more grids
    EXPECT_GT(questions(file(), "flame"), alone + 10000);
    const vdb::Volume volume = vdb::load(file(), {}).volume;
    EXPECT_EQ(volume.name, "density");
    EXPECT_EQ(volume.maximum, 0.5F);
    EXPECT_EQ(volume.size, glm::ivec3(9));
}

TEST_F(Reading, EmptyGridsAreLookedInto) {
    saveFile({makeGrid(), makeLeaves("smoke", 3)});
    const vdb::LoadResult loaded = vdb::load(file(), {});
    EXPECT_EQ(loaded.volume.name, "smoke");
    EXPECT_DOUBLE_EQ(mass(loaded.volume), 3.0);
}

TEST_F(Reading, GridsThatShareATree) {
    const auto first = makeLeaves("first", 5);
    const auto second = openvdb::FloatGrid::Ptr(first->copy());
    second->setName("second");
    second->setTransform(openvdb::math::Transform::createLinearTransform(2.0));
    saveFile({first, second});
    for (const auto& [name, expected] : {std::pair("first", 5.0), std::pair("second", 40.0)}) {
        vdb::LoadOptions options;
        options.grid = name;
        EXPECT_DOUBLE_EQ(mass(vdb::load(file(), options).volume), expected) << name;
    }
}

TEST_F(Reading, WhatTheCheckThrowsEndsIt) {
    const auto grid = makeLeaves("density", 500);
    const auto doubles = openvdb::createGrid<openvdb::DoubleGrid>(0.0);
    doubles->setName("density");
    doubles->fill(openvdb::CoordBBox(Coord(0), Coord(99)), 1.0);
    for (const auto& path : {save({grid}), file("seekable.vdb"), file("doubles.vdb")}) {
        if (path == file("seekable.vdb")) openvdb::io::File(path.string()).write(openvdb::GridCPtrVec{grid});
        if (path == file("doubles.vdb")) openvdb::io::File(path.string()).write(openvdb::GridCPtrVec{doubles});
        const int all = questions(path);
        ASSERT_GT(all, 20);
        for (int after = 0; after < all; after += std::max(1, all / 12)) {
            std::atomic<int> left = after;
            vdb::LoadOptions options;
            options.limits.check = [&] {
                if (left-- <= 0) throw Stop("enough");
            };
            EXPECT_THROW(vdb::load(path, options), Stop) << path << " after " << after << " of " << all;
        }
    }
}

// Also between leaves that are read one by one: that is no fault of the file
TEST_F(Reading, WhatTheCheckThrowsEndsStreamsOfLeaves) {
    const auto path = saveFile({makeLeaves("density", 6000)});
    vdb::LoadOptions options;
    std::atomic<int> all = 0;
    options.limits.check = [&] { ++all; };
    vdb::loadSparse(path, options);
    ASSERT_GT(all, 20);
    for (int after = 0; after < all; after += std::max(1, all.load() / 400)) {
        std::atomic<int> left = after;
        options.limits.check = [&] {
            if (left-- <= 0) throw Stop("enough");
        };
        EXPECT_THROW(vdb::loadSparse(path, options), Stop) << "after " << after << " of " << all;
    }
}

TEST_F(Reading, TreesAreCountedBeforeTheyAreMade) {
    const auto heavy = makeLeaves("heavy", 8000);  // 2 KiB of values each
    for (const auto& path : {save({makeBlob(Coord(0)), heavy}), file("seekable.vdb")}) {
        const bool seekable = path == file("seekable.vdb");
        if (seekable) openvdb::io::File(path.string()).write(openvdb::GridCPtrVec{makeBlob(Coord(0)), heavy});
        vdb::LoadOptions options;
        options.grid = "heavy";
        options.limits.treeMiB = 15.0;
        EXPECT_THAT(refusal(path, options), HasSubstr("more than 15 MiB while it is read"));
        options.limits.treeMiB = 40.0;
        EXPECT_EQ(refusal(path, options), "");
        // a stream has to be read from its start to its end
        options.grid = "density";
        options.limits.treeMiB = 15.0;
        EXPECT_EQ(refusal(path, options).empty(), seekable);
    }
    const auto tiles = makeGrid();  // active tiles in a few nodes
    tiles->sparseFill(openvdb::CoordBBox(Coord(0), Coord(255)), 1.0F);
    vdb::LoadOptions options;
    options.limits.treeMiB = 0.25;
    EXPECT_THAT(refusal(saveFile({tiles}), options), HasSubstr("while it is read"));
}

TEST_F(Reading, TilesThatClaimManyVoxels) {
    const auto grid = makeGrid();
    constexpr int across = 10, edge = 4096;  // 6.9e13 voxels
    for (int i = 0; i < across * across * across; ++i)
        grid->tree().root().addTile(placeOf(i, across, edge), 0.5F, true);
    vdb::LoadOptions options;
    options.memoryBudgetMiB = 1.0;
    const vdb::Volume volume = vdb::load(saveFile({grid}), options).volume;
    EXPECT_LE(volume.density.size(), std::size_t{1} << 19U);
    constexpr double side = double{across} * edge;
    EXPECT_NEAR(mass(volume), 0.5 * side * side * side, 1e-5 * side * side * side);
    EXPECT_FLOAT_EQ(volume.maximum, 0.5F);
}

TEST_F(Reading, FewBlocksFarApartTakeLittle) {
    const auto grid = makeGrid();
    grid->tree().setValue(Coord(-1000000), 1.0F);
    grid->tree().setValue(Coord(1000000), 3.0F);
    const vdb::LoadResult loaded = loadGrid(grid);
    EXPECT_LE(loaded.volume.density.size(), std::size_t{1} << 20U);
    EXPECT_GE(loaded.volume.size.x, 100);
    EXPECT_NEAR(mass(loaded.volume), 4.0, 1e-5);
    EXPECT_EQ(loaded.warnings.size(), 1U);
}

}  // namespace
}  // namespace lumulus::test
