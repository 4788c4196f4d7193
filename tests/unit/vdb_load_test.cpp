// What the loader makes of good files.
#include <openvdb/tools/Interpolation.h>

#include <chrono>
#include <random>

#include "support/rico.h"
#include "unit/vdb_grids.h"
#include "vdb/describe.h"
#include "vdb/transform.h"
#include "vdb/write.h"

namespace lumulus::test {
namespace {

using Load = GridFiles;
using openvdb::Coord;
using openvdb::CoordBBox;

constexpr double kMiB = 1024.0 * 1024.0;

/// The trilinear field of a volume at a point of its voxel coordinates; independent of the library.
double sampleVolume(const vdb::Volume& volume, const glm::dvec3& point) {
    const glm::dvec3 base = glm::floor(point - 0.5);
    const glm::dvec3 t = point - 0.5 - base;
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::ivec3 side(corner & 1, (corner >> 1) & 1, (corner >> 2) & 1);
        const glm::ivec3 at = glm::ivec3(base) + side;
        if (glm::any(glm::lessThan(at, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(at, volume.size))) continue;
        const glm::dvec3 w = glm::mix(1.0 - t, t, glm::dvec3(side));
        sum += w.x * w.y * w.z * static_cast<double>(volume.density[volume.index(at.x, at.y, at.z)]);
    }
    return sum;
}

/// Compares the volume with OpenVDB's own sampler at random world points around it.
void expectSameField(const vdb::Volume& volume, const openvdb::FloatGrid& grid, double tolerance) {
    const openvdb::tools::GridSampler<openvdb::FloatGrid, openvdb::tools::BoxSampler> sampler(grid);
    std::mt19937 random(7);  // raw draws only: the same numbers everywhere
    const auto uniform = [&] { return static_cast<double>(random()) * 0x1p-32; };
    for (int i = 0; i < 2000; ++i) {
        const glm::dvec3 local = glm::dvec3(uniform(), uniform(), uniform()) * glm::dvec3(volume.size);
        const glm::dvec3 world = volume.toWorld.point(local);
        const double expected = static_cast<double>(sampler.wsSample({world.x, world.y, world.z}));
        ASSERT_NEAR(sampleVolume(volume, local), expected, tolerance) << i;
    }
}

TEST_F(Load, ValuesSitAtIndexCoordinates) {
    const auto grid = makeBlob({-5, 40, 1003});
    grid->setTransform(openvdb::math::Transform::createLinearTransform(3.5));
    const auto result = loadGrid(grid);
    EXPECT_TRUE(result.warnings.empty());
    EXPECT_EQ(result.volume.size, glm::ivec3(9));
    EXPECT_TRUE(hasRing(result.volume));
    const glm::dvec3 middle = result.volume.toWorld.point({4.5, 4.5, 4.5});
    EXPECT_NEAR(glm::distance(middle, 3.5 * glm::dvec3(-5, 40, 1003)), 0.0, 1e-9);
    expectSameField(result.volume, *grid, 1e-6);
}

TEST_F(Load, ShearAndScaleAreKept) {
    const auto grid = makeBlob({7, 8, 9});
    openvdb::Mat4d rows(2.0, 0.5, 0.0, 0.0, -0.25, 3.0, 1.0, 0.0, 0.0, 0.75, 0.5, 0.0, 100.0, -50.0, 7.0, 1.0);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(rows));
    const auto result = loadGrid(grid);
    // voxel (8, 8, 9), one to the right of the middle
    const openvdb::Vec3d expected = grid->transform().indexToWorld(openvdb::Vec3d(8, 8, 9));
    const glm::dvec3 actual = result.volume.toWorld.point({5.5, 4.5, 4.5});
    EXPECT_NEAR(glm::distance(actual, {expected.x(), expected.y(), expected.z()}), 0.0, 1e-12);
    expectSameField(result.volume, *grid, 1e-6);
}

TEST_F(Load, TransformIsAppliedAfterTheGridsOwn) {
    const auto grid = makeBlob({0, 0, 0});
    grid->setTransform(openvdb::math::Transform::createLinearTransform(2.0));
    glm::dmat4 transform(1.0);
    transform[0] = {0, 0, -1, 0};  // turn by a quarter about y, and move far away
    transform[2] = {1, 0, 0, 0};
    transform[3] = {1e7, 0.25, -1e7, 1};
    const auto loaded = loadGrid(grid);
    const vdb::Affine placed = vdb::composeTransforms(transform, loaded.gridToWorld, "here");
    const vdb::Affine toWorld = vdb::composed(placed, loaded.voxelToGrid);
    const glm::dvec3 moved = toWorld.point({5.5, 4.5, 4.5});  // index (1, 0, 0), world (2, 0, 0)
    EXPECT_NEAR(glm::distance(moved, glm::dvec3(1e7, 0.25, -1e7 - 2.0)), 0.0, 1e-7);
}

TEST_F(Load, TilesKeepTheirMass) {
    const auto grid = makeGrid();
    grid->fill(CoordBBox({-3, -20, 5}, {60, 43, 100}), 0.5F);  // leaf-sized tiles and loose voxels
    grid->tree().prune();
    ASSERT_GT(grid->tree().activeTileCount(), 0U);
    const auto volume = loadGrid(grid).volume;
    EXPECT_EQ(volume.size, glm::ivec3(64, 64, 96) + 2);
    EXPECT_DOUBLE_EQ(mass(volume), 0.5 * 64 * 64 * 96);
    EXPECT_TRUE(hasRing(volume));
    EXPECT_EQ(volume.maximum, 0.5F);
}

TEST_F(Load, ZerosAroundTheCloudAreCropped) {
    const auto grid = makeGrid();
    grid->fill(CoordBBox(Coord(0), Coord(31)), 0.0F, true);
    grid->tree().setValue({10, 11, 12}, 2.0F);
    const auto volume = loadGrid(grid).volume;
    EXPECT_EQ(volume.size, glm::ivec3(3));
    EXPECT_EQ(volume.density[volume.index(1, 1, 1)], 2.0F);
    EXPECT_NEAR(glm::distance(volume.toWorld.point({1.5, 1.5, 1.5}), glm::dvec3(10, 11, 12)), 0.0, 1e-12);
}

TEST_F(Load, NothingActiveIsAnEmptyCloud) {
    const auto nothing = loadGrid(makeGrid());
    EXPECT_TRUE(nothing.volume.empty());
    EXPECT_EQ(nothing.volume.size, glm::ivec3(3));
    ASSERT_EQ(nothing.warnings.size(), 1U);
    EXPECT_NE(nothing.warnings[0].find("no active voxels"), std::string::npos);
    const auto off = makeBlob({0, 0, 0});
    for (auto value = off->beginValueOn(); value; ++value) value.setValueOff();
    EXPECT_NE(loadGrid(off).warnings.at(0).find("no active voxels"), std::string::npos);

    const auto grid = makeGrid();
    grid->fill(CoordBBox(Coord(0), Coord(20)), 0.0F, true);
    const auto zeros = loadGrid(grid);
    EXPECT_TRUE(zeros.volume.empty());
    ASSERT_EQ(zeros.warnings.size(), 1U);
    EXPECT_NE(zeros.warnings[0].find("zero everywhere"), std::string::npos);
}

TEST_F(Load, ChoosesTheGrid) {
    const auto heat = makeGrid(0.0F, "heat");
    heat->tree().setValue(Coord(1), 5.0F);
    const auto density = makeBlob({0, 0, 0});
    const auto velocity = openvdb::Vec3SGrid::create();
    velocity->setName("velocity");
    EXPECT_EQ(vdb::load(save({velocity, heat, density}), {}).volume.name, "density");
    EXPECT_EQ(vdb::load(save({velocity, heat}), {}).volume.name, "heat");
    vdb::LoadOptions options;
    options.grid = "heat";
    EXPECT_EQ(vdb::load(save({density, heat}), options).volume.maximum, 5.0F);
}

TEST_F(Load, MetadataOfAllTypes) {
    const auto grid = makeBlob({0, 0, 0});
    grid->insertMeta("a", openvdb::BoolMetadata(true));
    grid->insertMeta("b", openvdb::DoubleMetadata(0.5));
    grid->insertMeta("c", openvdb::FloatMetadata(0.5F));
    grid->insertMeta("d", openvdb::Int32Metadata(7));
    grid->insertMeta("e", openvdb::Int64Metadata(7));
    grid->insertMeta("f", openvdb::Vec2DMetadata({1, 2}));
    grid->insertMeta("g", openvdb::Vec2IMetadata({1, 2}));
    grid->insertMeta("h", openvdb::Vec2SMetadata({1, 2}));
    grid->insertMeta("i", openvdb::Vec3DMetadata({1, 2, 3}));
    grid->insertMeta("j", openvdb::Vec3IMetadata({1, 2, 3}));
    grid->insertMeta("k", openvdb::Vec3SMetadata({1, 2, 3}));
    grid->insertMeta("l", openvdb::Mat4SMetadata(openvdb::Mat4s::identity()));
    grid->insertMeta("m", openvdb::Mat4DMetadata(openvdb::Mat4d::identity()));
    grid->insertMeta("n", openvdb::StringMetadata("text"));
    EXPECT_EQ(loadGrid(grid).volume.size, glm::ivec3(9));
}

TEST_F(Load, HalfGrids) {
    const auto grid = makeBlob({0, 0, 0});
    grid->setSaveFloatAsHalf(true);
    const auto path = save({grid});
    EXPECT_EQ(vdb::describe(path).at(0).type, "half");
    const auto volume = vdb::load(path, {}).volume;
    EXPECT_NEAR(volume.density[volume.index(4, 4, 4)], 0.5F, 5e-4F);
}

TEST_F(Load, BudgetCoarseningPreservesMassAndPlace) {
    const auto grid = makeGrid();
    grid->fill(CoordBBox({-10, 3, 0}, {53, 34, 40}), 0.75F);
    grid->tree().setValue({70, 40, 50}, 11.0F);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
    const auto fine = loadGrid(grid).volume;
    ASSERT_EQ(fine.size, glm::ivec3(81, 38, 51) + 2);
    vdb::LoadOptions options;
    options.memoryBudgetMiB = 2.0 * 30 * 16 * 20 / kMiB;  // 81×38×51 in boxes of 3³ with a ring: 29×15×19
    const auto result = loadGrid(grid, options);
    EXPECT_EQ(result.volume.size, glm::ivec3(29, 15, 19));
    ASSERT_EQ(result.warnings.size(), 1U);
    EXPECT_NE(result.warnings[0].find("81x38x51"), std::string::npos) << result.warnings[0];
    EXPECT_NE(result.warnings[0].find("27x13x17"), std::string::npos) << result.warnings[0];
    EXPECT_NEAR(mass(result.volume), mass(fine), 1e-6 * mass(fine));
    EXPECT_TRUE(hasRing(result.volume));
    EXPECT_DOUBLE_EQ(result.wantedMiB, 2.0 * 83 * 40 * 53 / kMiB);
    // the corner of what is not zero stays where it is
    EXPECT_NEAR(glm::distance(result.volume.toWorld.point(glm::dvec3(1)), fine.toWorld.point(glm::dvec3(1))), 0.0,
                1e-12);
    // the last box holds one voxel of 11 and 26 of nothing
    EXPECT_FLOAT_EQ(result.volume.density[result.volume.index(27, 13, 17)], 11.0F / 27.0F);
}

TEST_F(Load, CoarseningLeavesInactiveVoxelsOut) {
    const auto grid = makeGrid(0.25F);
    grid->tree().setValue({0, 0, 0}, 1.0F);
    grid->tree().setValue({40, 40, 40}, 2.0F);
    grid->tree().setValueOff({20, 20, 20}, 9.0F);
    vdb::LoadOptions options;
    options.maxExtent = 12;
    const auto result = loadGrid(grid, options);
    EXPECT_EQ(result.volume.size, glm::ivec3(11));  // boxes of 5³
    EXPECT_EQ(result.warnings.size(), 2U);
    EXPECT_NEAR(mass(result.volume), 3.0, 1e-6);
}

TEST_F(Load, TwoVoxelsFarApart) {
    const auto grid = makeGrid();
    grid->tree().setValue({0, 0, 0}, 1.0F);
    grid->tree().setValue({1000000, 1000, 0}, 3.0F);
    const auto start = std::chrono::steady_clock::now();
    const auto volume = loadGrid(grid).volume;
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    EXPECT_LE(volume.size.x, 2048);
    EXPECT_NEAR(mass(volume), 4.0, 1e-5);
    EXPECT_LT(seconds.count(), 2.0);
}

TEST_F(Load, CoordinatesAtTheEndsOfInt) {
    constexpr int smallest = std::numeric_limits<int>::min();
    constexpr int largest = std::numeric_limits<int>::max();
    const auto grid = makeGrid();
    grid->tree().setValue(Coord(smallest, smallest, 0), 1.0F);
    grid->tree().setValue(Coord(largest, largest, 7), 1.0F);
    vdb::LoadOptions options;
    options.maxExtent = 256;
    const auto volume = loadGrid(grid, options).volume;
    EXPECT_LE(volume.size.x, 256);
    EXPECT_NEAR(mass(volume), 2.0, 1e-5);

    const auto corner = makeGrid();
    corner->tree().setValue(Coord(largest), 2.0F);
    const auto single = loadGrid(corner).volume;
    EXPECT_EQ(single.size, glm::ivec3(3));
    EXPECT_EQ(single.toWorld.point({1.5, 1.5, 1.5}), glm::dvec3(largest));
}

TEST_F(Load, DescribeTellsWhatIsThere) {
    const auto grid = makeGrid(0.0F, "smoke");
    grid->fill(CoordBBox({1, 2, 3}, {2, 4, 6}), 0.5F);
    grid->tree().setValue({1, 2, 3}, 2.5F);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(0.1));
    const auto ids = openvdb::Int32Grid::create();
    ids->setName("ids");
    ids->setGridClass(openvdb::GRID_LEVEL_SET);
    const auto infos = vdb::describe(save({grid, ids}));
    ASSERT_EQ(infos.size(), 2U);
    EXPECT_EQ(infos[0].name, "smoke");
    EXPECT_EQ(infos[0].type, "float");
    EXPECT_EQ(infos[0].gridClass, "fog volume");
    EXPECT_TRUE(infos[0].affine);
    EXPECT_EQ(infos[0].activeVoxels, 24U);
    EXPECT_EQ(infos[0].activeMinimum, glm::ivec3(1, 2, 3));
    EXPECT_EQ(infos[0].activeMaximum, glm::ivec3(2, 4, 6));
    EXPECT_NEAR(infos[0].voxelSize.y, 0.1, 1e-12);
    ASSERT_TRUE(infos[0].values);
    EXPECT_EQ(infos[0].values->minimum, 0.5);
    EXPECT_EQ(infos[0].values->maximum, 2.5);
    EXPECT_NEAR(infos[0].values->mean, (23 * 0.5 + 2.5) / 24, 1e-12);
    EXPECT_EQ(infos[1].type, "int32");
    EXPECT_TRUE(infos[1].levelSet);
    EXPECT_FALSE(infos[1].values);
}

TEST_F(Load, DisneyCloud) {
    const auto path = findTestData("wdas_cloud_sixteenth.vdb");
    if (!path) {
        std::puts("the Disney cloud is not here; the other cases use grids of their own");
        return;
    }
    const auto start = std::chrono::steady_clock::now();
    const auto result = vdb::load(*path, {});
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    std::printf("loaded in %.3f s\n", seconds.count());
    EXPECT_LT(seconds.count(), 2.0);  // 0.1 s on a quiet machine
    EXPECT_TRUE(hasRing(result.volume));
    EXPECT_LE(result.volume.maximum, 1.0F);
    EXPECT_EQ(vdb::describe(*path).at(0).name, "density");
    expectSameField(result.volume, *openvdb::gridPtrCast<openvdb::FloatGrid>([&] {
                        openvdb::io::File file(path->string());
                        file.open(false);
                        return file.readGrid("density");
                    }()),
                    1e-5);
}

TEST_F(Load, RicoCloud) {
    const auto path = findTestData("rico122x106x39.txt");
    if (!path) {
        std::puts("the RICO cloud is not here; the other cases use grids of their own");
        return;
    }
    const vdb::Volume rico = readRico(*path);
    EXPECT_EQ(rico.size, glm::ivec3(122, 39, 106));
    EXPECT_TRUE(hasRing(rico));
    vdb::write(rico, file("rico.vdb"));
    const auto loaded = vdb::load(file("rico.vdb"), {}).volume;
    EXPECT_EQ(loaded.maximum, rico.maximum);
    EXPECT_NEAR(mass(loaded), mass(rico), 1e-9 * mass(rico));
    // the file's cell 1,33,4: LWC 0.0111 g/m³, r_e 13.314 µm, altitude 600 m
    const glm::dvec3 world((1 - 60.5) * 20.0, 600.0, -(33 - 52.5) * 20.0);
    const glm::dvec3 local = glm::inverse(loaded.toWorld.linear) * (world - loaded.toWorld.translation);
    EXPECT_NEAR(sampleVolume(loaded, local), 1.5 * 0.0111 / 13.314, 1e-8);
}

}  // namespace
}  // namespace lumulus::test
