// NanoVDB files.
#include <blosc.h>
#include <gmock/gmock.h>
#include <zlib.h>

#define NANOVDB_USE_ZIP
#define NANOVDB_USE_BLOSC
#include <nanovdb/util/IO.h>
#include <nanovdb/util/OpenToNanoVDB.h>

#include "unit/vdb_grids.h"
#include "vdb/describe.h"

namespace lumulus::test {
namespace {

using nanovdb::io::Codec;
using openvdb::Coord;
using testing::AllOf;
using testing::HasSubstr;

class Nano : public GridFiles {
  protected:
    template <typename Grid>
    std::filesystem::path saveNano(const Grid& grid, Codec codec = Codec::NONE) const {
        const auto path = file("grid.nvdb");
        nanovdb::io::writeGrid(path.string(), nanovdb::openToNanoVDB(*grid), codec);
        return path;
    }

    template <typename Build>
    std::filesystem::path saveQuantised(openvdb::FloatGrid& grid) const {
        const auto path = file("grid.nvdb");
        nanovdb::OpenToNanoVDB<float, Build> converter;
        nanovdb::io::writeGrid(path.string(), converter(grid));
        return path;
    }

    /// A smooth blob, a tile and a lone voxel under a sheared transform.
    static openvdb::FloatGrid::Ptr makeCloud() {
        const auto grid = makeBlob({3, 4, 5}, 6);
        grid->tree().addTile(1, Coord(32, 0, 0), 0.25F, true);
        grid->tree().setValue({-200, 3, 3}, 0.125F);
        grid->setTransform(openvdb::math::Transform::createLinearTransform(
            openvdb::Mat4d(2.0, 0.5, 0.0, 0.0, -0.25, 3.0, 1.0, 0.0, 0.0, 0.75, 0.5, 0.0, 100.0, -50.0, 7.0, 1.0)));
        return grid;
    }
};

void expectSame(const vdb::Volume& actual, const vdb::Volume& expected, float tolerance) {
    ASSERT_EQ(actual.size, expected.size);
    EXPECT_EQ(actual.name, expected.name);
    for (std::size_t i = 0; i < actual.density.size(); ++i)
        ASSERT_NEAR(actual.density[i], expected.density[i], tolerance) << i;
    for (int axis = 0; axis < 3; ++axis)
        EXPECT_LT(glm::distance(actual.toWorld.linear[axis], expected.toWorld.linear[axis]), 1e-12);
    EXPECT_LT(glm::distance(actual.toWorld.translation, expected.toWorld.translation), 1e-9);
}

TEST_F(Nano, FloatsAreThoseOfTheOpenVdbFile) {
    const auto grid = makeCloud();
    const vdb::Volume expected = loadGrid(grid).volume;
    for (const Codec codec : {Codec::NONE, Codec::ZIP, Codec::BLOSC}) {
        const auto loaded = vdb::load(saveNano(grid, codec), {});
        EXPECT_TRUE(loaded.warnings.empty());
        expectSame(loaded.volume, expected, 0.0F);
    }
}

TEST_F(Nano, DoublesAndQuantisedFloats) {
    const auto grid = makeCloud();
    const vdb::Volume expected = loadGrid(grid).volume;
    const auto doubles = openvdb::DoubleGrid::create(std::make_shared<openvdb::DoubleTree>(grid->tree()));
    doubles->setName("density");
    doubles->setTransform(grid->transformPtr());
    expectSame(vdb::load(saveNano(doubles), {}).volume, expected, 0.0F);
    // half a step of the largest value, 0.5
    expectSame(vdb::load(saveQuantised<nanovdb::Fp4>(*grid), {}).volume, expected, 0.5F / 15.0F);
    expectSame(vdb::load(saveQuantised<nanovdb::Fp8>(*grid), {}).volume, expected, 0.5F / 255.0F);
    expectSame(vdb::load(saveQuantised<nanovdb::Fp16>(*grid), {}).volume, expected, 0.5F / 65535.0F);
    expectSame(vdb::load(saveQuantised<nanovdb::FpN>(*grid), {}).volume, expected, 0.02F);
    EXPECT_EQ(vdb::describe(file("grid.nvdb")).at(0).type, "FloatN");
}

TEST_F(Nano, SeveralGrids) {
    const auto velocity = openvdb::Vec3SGrid::create();
    velocity->setName("velocity");
    velocity->tree().setValue({0, 0, 0}, openvdb::Vec3s(1.0F));
    const auto heat = makeBlob({0, 0, 0});
    heat->setName("heat");
    const auto grid = makeCloud();
    std::vector<nanovdb::GridHandle<>> handles;
    handles.push_back(nanovdb::openToNanoVDB(*velocity));
    handles.push_back(nanovdb::openToNanoVDB(*heat));
    handles.push_back(nanovdb::openToNanoVDB(*grid));
    const auto path = file("grids.vdb");  // by its content, whatever its name
    nanovdb::io::writeGrids(path.string(), handles, Codec::ZIP);
    EXPECT_EQ(vdb::load(path, {}).volume.name, "density");
    const auto infos = vdb::describe(path);
    ASSERT_EQ(infos.size(), 3U);
    EXPECT_EQ(infos[0].name, "velocity");
    EXPECT_EQ(infos[0].type, "Vec3f");
    EXPECT_TRUE(infos[2].taken);
    EXPECT_EQ(infos[2].activeVoxels, grid->activeVoxelCount());
    vdb::LoadOptions options;
    options.grid = "velocity";
    EXPECT_THAT(refusal(path, options), HasSubstr("type Vec3f"));
}

/// Places to cut or to damage: all of the head, and some of the nodes.
std::vector<std::size_t> places(std::size_t bytes) {
    std::vector<std::size_t> list;
    for (std::size_t at = 1; at < bytes; at += at < 1200 ? 7 : 997) list.push_back(at);
    return list;
}

TEST_F(Nano, TruncatedAnywhere) {
    for (const Codec codec : {Codec::NONE, Codec::ZIP, Codec::BLOSC}) {
        const auto path = saveNano(makeBlob({3, 3, 3}, 1), codec);
        const std::string whole = readAll(path);
        for (const std::size_t length : places(whole.size())) {
            writeAll(path, whole.substr(0, length));
            ASSERT_NE(refusal(path), "") << length << " of " << whole.size();
        }
    }
}

TEST_F(Nano, DamageNeverCrashes) {
    const auto path = saveQuantised<nanovdb::FpN>(*makeBlob({3, 3, 3}, 1));
    const std::string whole = readAll(path);
    int refused = 0;
    for (const std::size_t at : places(whole.size())) {
        for (const char mask : {'\x01', '\x80', '\xFF'}) {
            std::string damaged = whole;
            damaged[at] = static_cast<char>(damaged[at] ^ mask);
            writeAll(path, damaged);
            vdb::LoadOptions options;
            options.memoryBudgetMiB = 1.0;
            try {
                vdb::load(path, options);
            } catch (const Error&) {
                ++refused;
            }
        }
    }
    EXPECT_GT(refused, 30);
}

TEST_F(Nano, SharedNodesAreNoBomb) {
    // every child of the upper node is made the first one
    const auto grid = makeGrid();
    for (int i = 0; i < 16; ++i) grid->tree().setValue({128 * i, 0, 0}, 1.0F);
    const auto path = saveNano(grid);
    std::string bytes = readAll(path);
    const std::size_t start = bytes.size() - nanovdb::openToNanoVDB(*grid).size();
    nanovdb::GridHandle<> handle = nanovdb::openToNanoVDB(*grid);
    auto& upper =
        *const_cast<nanovdb::NanoUpper<float>::DataType*>(handle.grid<float>()->tree().getFirstNode<2>()->data());
    std::int64_t first = 0;
    for (std::uint32_t n = 0; n < 32768; ++n)
        if (upper.mChildMask.isOn(n)) {
            if (first == 0) first = upper.mTable[n].child;
            upper.mTable[n].child = first;
        }
    for (std::uint32_t n = 0; n < 32768; ++n) {
        upper.mChildMask.setOn(n);
        upper.mTable[n].child = first;
    }
    bytes.replace(start, handle.size(), reinterpret_cast<const char*>(handle.data()), handle.size());
    writeAll(path, bytes);
    EXPECT_THAT(refusal(path), HasSubstr("nodes are shared"));
}

TEST_F(Nano, OtherVersions) {
    const auto path = saveNano(makeBlob({3, 3, 3}, 1));
    std::string bytes = readAll(path);
    const std::uint32_t old = 29U << 21U;
    bytes.replace(8, sizeof(old), reinterpret_cast<const char*>(&old), sizeof(old));
    writeAll(path, bytes);
    EXPECT_THAT(refusal(path), AllOf(HasSubstr("version 29 of NanoVDB"), HasSubstr("convert")));
    writeAll(path, "NanoVDB1" + std::string(1000, '\0'));
    EXPECT_THAT(refusal(path), HasSubstr("bare NanoVDB grid"));
}

}  // namespace
}  // namespace lumulus::test
