#include <openvdb/openvdb.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <cstdio>
#include <filesystem>
#include <limits>
#include <string>

// Writes the OpenVDB files that the tests of the command line render, good and bad: make_vdb_fixtures FOLDER
namespace {

using openvdb::Coord;
using openvdb::FloatGrid;

/// The voxel size in metres: a number that is easy to find in the file, for the test that damages the transform.
constexpr double voxelSize = 1.2345678;

FloatGrid::Ptr emptyGrid() {
    auto grid = FloatGrid::create(0.0F);
    grid->setName("density");
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(voxelSize));
    return grid;
}

/// A ball of density 1, radius 6 voxels.
FloatGrid::Ptr ball() {
    auto grid = emptyGrid();
    auto accessor = grid->getAccessor();
    for (int z = -6; z <= 6; ++z) {
        for (int y = -6; y <= 6; ++y) {
            for (int x = -6; x <= 6; ++x) {
                if (x * x + y * y + z * z <= 36) accessor.setValue(Coord(x, y, z), 1.0F);
            }
        }
    }
    return grid;
}

FloatGrid::Ptr ballWith(float value) {
    auto grid = ball();
    grid->tree().setValue(Coord(1, 2, 3), value);
    return grid;
}

FloatGrid::Ptr oneVoxel() {
    auto grid = emptyGrid();
    grid->tree().setValue(Coord(0, 0, 0), 1.0F);
    return grid;
}

/// A cube of 24³ voxels whose densities `value(x, y, z)` gives.
template <typename Value>
FloatGrid::Ptr cube(const Value& value) {
    auto grid = emptyGrid();
    auto accessor = grid->getAccessor();
    for (int z = 0; z < 24; ++z) {
        for (int y = 0; y < 24; ++y) {
            for (int x = 0; x < 24; ++x) accessor.setValue(Coord(x, y, z), value(x, y, z));
        }
    }
    return grid;
}

/// Density 1 with one voxel of 10⁶ in the middle.
FloatGrid::Ptr spike() {
    return cube([](int x, int y, int z) { return x == 12 && y == 12 && z == 12 ? 1e6F : 1.0F; });
}

/// Every other voxel is empty, in all three directions.
FloatGrid::Ptr checkerboard() {
    return cube([](int x, int y, int z) { return static_cast<float>((x + y + z) % 2); });
}

FloatGrid::Ptr zeros() {
    auto grid = emptyGrid();
    grid->fill(openvdb::CoordBBox(Coord(0), Coord(9)), 0.0F, true);
    return grid;
}

FloatGrid::Ptr farAway() {
    auto grid = ball();
    grid->transform().postTranslate(openvdb::Vec3d(1e7, 1e7, -1e7));
    return grid;
}

FloatGrid::Ptr levelSet() {
    auto grid = openvdb::tools::createLevelSetSphere<FloatGrid>(6.0F, openvdb::Vec3f(0.0F), 1.0F);
    grid->setName("density");
    return grid;
}

openvdb::Vec3SGrid::Ptr vectors() {
    auto grid = openvdb::Vec3SGrid::create();
    grid->setName("density");
    grid->tree().setValue(Coord(0, 0, 0), openvdb::Vec3f(1.0F));
    return grid;
}

/// A ball of another name, its densities multiplied.
FloatGrid::Ptr ballNamed(const std::string& name, float factor = 1.0F) {
    auto grid = ball();
    for (auto value = grid->beginValueOn(); value; ++value) value.setValue(*value * factor);
    grid->setName(name);
    return grid;
}

/// Flame and heat of other shapes before the smoke, which is a ball.
void writeFire(const std::filesystem::path& path) {
    auto flame = cube([](int, int, int) { return 5.0F; });
    flame->setName("flame");
    openvdb::io::File file(path.string());
    file.write(openvdb::GridPtrVec{flame, ballNamed("heat", 300.0F), ballNamed("Smoke")});
}

/// 10¹⁵ voxels: tiles of 4096³ in the root of the tree, of two densities, every other one.
FloatGrid::Ptr manyTiles() {
    constexpr int across = 25, edge = 4096;
    auto grid = emptyGrid();
    for (int i = 0; i < across * across * across; ++i) {
        const Coord at(2 * edge * (i % across), edge * (i / across % across), edge * (i / across / across));
        grid->tree().root().addTile(at, i % 2 == 0 ? 1.0F : 0.5F, true);
    }
    return grid;
}

/// Two voxels of one weight, as far apart as coordinates go.
FloatGrid::Ptr twoFarVoxels() {
    auto grid = emptyGrid();
    grid->tree().setValue(Coord(-2'000'000'000), 1.0F);
    grid->tree().setValue(Coord(2'000'000'000), 1.0F);
    return grid;
}

/// A ball, and a grid that nobody asks for, of 100,000 leaves.
void writeCrowded(const std::filesystem::path& path) {
    auto other = FloatGrid::create(0.0F);
    other->setName("temperature");
    auto accessor = other->getAccessor();
    for (int i = 0; i < 100'000; ++i)
        accessor.setValue(Coord(8 * (i % 100), 8 * (i / 100 % 100), 8 * (i / 10'000)), 1.0F);
    openvdb::io::File file(path.string());
    file.write(openvdb::GridPtrVec{ball(), other});
}

void write(const std::filesystem::path& path, const openvdb::GridBase::Ptr& grid) {
    openvdb::io::File file(path.string());
    file.write(openvdb::GridPtrVec{grid});
}

/// The ball in a stream of `speed` m/s along x, whose grid lies so many voxels from it.
void writeMoving(const std::filesystem::path& path, float speed, int away) {
    auto velocity = openvdb::Vec3SGrid::create();
    velocity->setName("Velocity");
    velocity->setTransform(openvdb::math::Transform::createLinearTransform(voxelSize));
    velocity->fill(openvdb::CoordBBox(Coord(away - 8, -8, -8), Coord(away + 8, 8, 8)), {speed, 0.0F, 0.0F});
    openvdb::io::File(path.string()).write(openvdb::GridPtrVec{ball(), velocity});
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fputs("usage: make_vdb_fixtures FOLDER\n", stderr);
        return 2;
    }
    openvdb::initialize();
    const std::filesystem::path folder = argv[1];
    write(folder / "ball.vdb", ball());
    write(folder / "far.vdb", farAway());
    write(folder / "one-voxel.vdb", oneVoxel());
    write(folder / "spike.vdb", spike());
    write(folder / "checkerboard.vdb", checkerboard());
    write(folder / "zeros.vdb", zeros());
    write(folder / "nan.vdb", ballWith(std::numeric_limits<float>::quiet_NaN()));
    write(folder / "infinite.vdb", ballWith(std::numeric_limits<float>::infinity()));
    write(folder / "negative.vdb", ballWith(-0.5F));
    write(folder / "level-set.vdb", levelSet());
    write(folder / "vectors.vdb", vectors());
    write(folder / "thin.vdb", ballNamed("density", 1e-5F));
    write(folder / "small-negative.vdb", ballWith(-1e-7F));
    writeFire(folder / "fire.vdb");
    write(folder / "many-tiles.vdb", manyTiles());
    write(folder / "two-far-voxels.vdb", twoFarVoxels());
    writeCrowded(folder / "crowded.vdb");
    writeMoving(folder / "moving-0.vdb", 1.0F, 0);
    writeMoving(folder / "moving-1.vdb", std::numeric_limits<float>::quiet_NaN(), 0);
    writeMoving(folder / "moving-2.vdb", 1.0F, 0);
    writeMoving(folder / "moving-3.vdb", 1.0F, 1000);
    return 0;
}
