// What the loader says to files that it cannot use. None of them may crash it.
#include <gmock/gmock.h>

#include <malloc.h>

#include <cstring>
#include <limits>

#include <openvdb/tools/ChangeBackground.h>

#include "unit/vdb_grids.h"
#include "vdb/describe.h"
#include "vdb/transform.h"

namespace lumulus::test {
namespace {

using Refusal = GridFiles;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST_F(Refusal, NoSuchFile) {
    EXPECT_THAT(refusal(file("absent.vdb")), HasSubstr("no such file"));
}

TEST_F(Refusal, Folder) {
    EXPECT_THAT(refusal(file("").parent_path()), HasSubstr("folder"));
}

TEST_F(Refusal, Device) {
    EXPECT_THAT(refusal("/dev/null"), HasSubstr("not a regular file"));
}

TEST_F(Refusal, EmptyFile) {
    writeAll(file(), "");
    EXPECT_THAT(refusal(file()), HasSubstr("empty"));
}

TEST_F(Refusal, OtherFormat) {
    writeAll(file(), "solid cube\nfacet normal 0 0 1\n");
    EXPECT_THAT(refusal(file()), HasSubstr("not an OpenVDB file"));
    writeAll(file(), "\x1f\x8b\x08\x08 packed");
    EXPECT_THAT(refusal(file()), AllOf(HasSubstr("a gzip archive"), HasSubstr("gunzip")));
    writeAll(file(), "version https://git-lfs.github.com/spec/v1\noid sha256:12\nsize 7\n");
    EXPECT_THAT(refusal(file()), AllOf(HasSubstr("Git LFS"), HasSubstr("git lfs pull")));
}

TEST_F(Refusal, NewerFormat) {
    std::string bytes = readAll(save({makeBlob({0, 0, 0})}));
    bytes[9] = 1;  // the version follows the eight bytes of the magic number
    writeAll(file(), bytes);
    EXPECT_THAT(refusal(file()), HasSubstr("newer OpenVDB"));
}

TEST_F(Refusal, FormatOf2012) {
    std::string bytes = readAll(save({makeBlob({0, 0, 0})}));
    bytes[8] = static_cast<char>(215);
    writeAll(file(), bytes);
    EXPECT_THAT(refusal(file()), HasSubstr("OpenVDB of 2012 (format 215)"));
}

/// The places to damage: every byte of the head and of the tail; the node masks between are all alike, each 37th does.
std::vector<std::size_t> damagePlaces(std::size_t bytes) {
    constexpr std::size_t closely = 500;
    std::vector<std::size_t> places;
    for (std::size_t at = 1; at < bytes; at += at < closely || at + closely > bytes ? 1 : 37) places.push_back(at);
    return places;
}

TEST_F(Refusal, TruncatedAnywhere) {
    const auto grid = makeBlob({3, 3, 3}, 1);
    const std::string whole = readAll(save({grid}));
    for (const std::size_t length : damagePlaces(whole.size())) {
        writeAll(file(), whole.substr(0, length));
        ASSERT_THAT(refusal(file()), HasSubstr("truncated")) << length << " of " << whole.size();
    }
    writeAll(file(), whole);
    EXPECT_EQ(refusal(file()), "");
}

/// Nodes that have not been read hold the background, which must not be taken for their children.
TEST_F(Refusal, TruncatedAnywhereWithABackground) {
    const auto half = makeBlob({3, 3, 3}, 1);
    half->setSaveFloatAsHalf(true);
    for (const auto& grid : {makeBlob({3, 3, 3}, 1), half}) {
        openvdb::tools::changeBackground(grid->tree(), 0.25F);
        const std::string whole = readAll(save({grid}));
        for (const std::size_t length : damagePlaces(whole.size())) {
            writeAll(file(), whole.substr(0, length));
            ASSERT_THAT(refusal(file()), HasSubstr("truncated")) << length << " of " << whole.size();
        }
    }
}

/// OpenVDB 10 itself loses the node below the root, 0.3 MB, wherever reading ends in it.
TEST_F(Refusal, TruncatedFilesLeaveNothingInMemory) {
    const std::string whole = readAll(save({makeBlob({3, 3, 3}, 1)}));
    const auto readOften = [&](int times) {
        for (int i = 0; i < times; ++i) {
            writeAll(file(), whole.substr(0, whole.size() * (50 + static_cast<std::size_t>(i % 40)) / 100));
            ASSERT_THAT(refusal(file()), HasSubstr("truncated"));
        }
    };
    readOften(40);
    const std::size_t before = mallinfo2().uordblks;
    readOften(80);
    EXPECT_LT(mallinfo2().uordblks, before + (1U << 20U));
}

/// OpenVDB's message quotes the name of the transform as it stands in the file.
TEST_F(Refusal, OneLineWhateverIsQuoted) {
    std::string bytes = readAll(save({makeBlob({3, 3, 3}, 1)}));
    const std::size_t name = bytes.find("UniformScaleMap");
    ASSERT_NE(name, std::string::npos);
    bytes[name + 3] = '\n';
    writeAll(file(), bytes);
    EXPECT_THAT(refusal(file()), AllOf(HasSubstr("Uni ormScaleMap"), Not(HasSubstr("\n"))));
}

TEST_F(Refusal, DamageNeverCrashes) {
    const std::string whole = readAll(save({makeBlob({3, 3, 3}, 1)}));
    int refused = 0;
    for (const std::size_t at : damagePlaces(whole.size())) {
        std::string damaged = whole;
        damaged[at] = static_cast<char>(damaged[at] ^ 1);
        writeAll(file(), damaged);
        vdb::LoadOptions options;
        options.memoryBudgetMiB = 1.0;
        try {
            vdb::load(file(), options);
        } catch (const Error&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, 50);
}

// A bool in OpenVDB's memory (found by the fuzz target vdb)
TEST_F(Refusal, TileNeitherActiveNorInactive) {
    const auto grid = makeBlob({3, 3, 3}, 1);
    const openvdb::Coord tile(4096, 0, 0);
    constexpr float value = 0.25F;
    grid->tree().root().addTile(tile, value, false);
    const std::string whole = readAll(save({grid}));
    EXPECT_EQ(refusal(file()), "");
    const std::string coordinates(reinterpret_cast<const char*>(tile.data()), 12);
    const std::string start = coordinates + std::string(reinterpret_cast<const char*>(&value), sizeof(value));
    const std::size_t flag = whole.find(start) + start.size();
    ASSERT_EQ(whole.at(flag), 0);
    for (const char wrong : {'\x02', '\xff'}) {
        std::string damaged = whole;
        damaged[flag] = wrong;
        writeAll(file(), damaged);
        EXPECT_THAT(refusal(file()), HasSubstr("neither active nor inactive"));
    }
}

/// With the four bytes behind the last `name` and so many others changed to a number.
std::string withNumber(std::string bytes, const std::string& name, std::size_t behind, std::uint32_t number) {
    const std::size_t at = bytes.rfind(name) + name.size() + behind;
    std::memcpy(&bytes.at(at), &number, sizeof(number));
    return bytes;
}

// OpenVDB then takes whatever follows for the length of a name, up to 4 GiB (found by the fuzz target vdb)
TEST_F(Refusal, MetadataThatOpenVdbReadsByItsOwnSize) {
    const auto grid = makeBlob({3, 3, 3}, 1);
    grid->insertMeta("place", openvdb::Vec3IMetadata({1, 2, 3}));
    const std::string whole = readAll(save({grid}));
    EXPECT_EQ(refusal(file()), "");
    std::string other = whole;
    other.at(other.find("vec3i", other.find("place")) + 3) = '4';
    writeAll(file(), other);
    EXPECT_THAT(refusal(file()), HasSubstr("truncated or damaged"));

    other = whole;
    constexpr std::size_t countAt = 57;
    constexpr std::uint32_t many = 0xDBDBDB00U;  // beyond 2^31
    std::memcpy(&other.at(countAt), &many, sizeof(many));
    writeAll(file(), other);
    EXPECT_THAT(refusal(file()), HasSubstr("truncated or damaged"));

    constexpr std::size_t leaves = 4, stored = 8;  // behind the length of the value
    ASSERT_NE(whole.find("__delayedload"), std::string::npos);
    for (const auto& [behind, number] : {std::pair{leaves, 0x7FFFFFFFU}, {stored, 0x7FFFFFFFU}, {stored, 17U}}) {
        writeAll(file(), withNumber(whole, "__delayedload", behind, number));
        EXPECT_THAT(refusal(file()), HasSubstr("truncated or damaged")) << behind << ' ' << number;
    }
}

TEST_F(Refusal, GridNotInTheFile) {
    const auto grid = makeBlob({0, 0, 0});
    vdb::LoadOptions options;
    options.grid = "smoke";
    EXPECT_THAT(refusal(save({grid}), options),
                AllOf(HasSubstr("no grid \"smoke\""), HasSubstr("\"density\" (float)")));
}

TEST_F(Refusal, OtherTypes) {
    const auto ids = openvdb::Int32Grid::create();
    ids->setName("ids");
    const auto vectors = openvdb::Vec3SGrid::create();
    vectors->setName("density");
    EXPECT_THAT(refusal(save({ids})), AllOf(HasSubstr("no float grid"), HasSubstr("\"ids\" (int32)")));
    vdb::LoadOptions options;
    options.grid = "density";
    EXPECT_THAT(refusal(save({ids, vectors}), options), HasSubstr("type vec3s"));
}

TEST_F(Refusal, LevelSet) {
    const auto grid = makeBlob({0, 0, 0});
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    EXPECT_THAT(refusal(save({grid})), AllOf(HasSubstr("level set"), HasSubstr("fog volume")));
}

TEST_F(Refusal, FileWithoutGrids) {
    EXPECT_THAT(refusal(save({})), HasSubstr("no grids"));
}

TEST_F(Refusal, ValuesThatAreNoDensities) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    constexpr float infinity = std::numeric_limits<float>::infinity();
    for (const auto& [value, text] : {std::pair{nan, "nan"}, {infinity, "inf"}, {-0.5F, "-0.5"}}) {
        const auto grid = makeBlob({0, 0, 0});
        grid->tree().setValue({40, -7, 12}, value);
        grid->tree().setValue({40, -8, 90}, value);  // smaller in lexicographic order
        grid->tree().setValue({300, -90, 0}, value);
        EXPECT_THAT(refusal(save({grid})), AllOf(HasSubstr(text), HasSubstr("(40, -8, 90)")));
    }
}

TEST_F(Refusal, TilesThatAreNoDensities) {
    const auto grid = makeBlob({0, 0, 0});
    grid->tree().addTile(1, openvdb::Coord(16, 24, 32), -1.0F, true);
    EXPECT_THAT(refusal(save({grid})), HasSubstr("value -1 at voxel (16, 24, 32)"));
}

TEST_F(Refusal, Frustum) {
    const auto grid = makeBlob({0, 0, 0});
    grid->setTransform(openvdb::math::Transform::createFrustumTransform(
        openvdb::BBoxd(openvdb::Vec3d(0), openvdb::Vec3d(100)), 0.5, 10.0));
    const auto path = save({grid});
    EXPECT_THAT(refusal(path), HasSubstr("frustum"));
    EXPECT_FALSE(vdb::describe(path).at(0).affine);
}

TEST_F(Refusal, TransformsWithoutVolume) {
    const auto refused = [](const glm::dmat4& transform) -> std::string {
        try {
            vdb::composeTransforms(transform, vdb::Affine{}, "here");
        } catch (const InputError& e) {
            return e.what();
        }
        return "";
    };
    glm::dmat4 transform(1.0);
    transform[1] = {1.0, 1e-14, 0.0, 0.0};  // parallel to the first axis
    EXPECT_THAT(refused(transform), HasSubstr("singular"));
    transform = glm::dmat4(1e-7);  // small, but not flat
    transform[3] = {0, 0, 0, 1};
    EXPECT_EQ(refused(transform), "");
    transform[3][3] = 2.0;
    EXPECT_THAT(refused(transform), HasSubstr("not affine"));
    transform = glm::dmat4(1.0);
    transform[3][0] = std::numeric_limits<double>::infinity();
    EXPECT_THAT(refused(transform), HasSubstr("not finite"));
}

TEST_F(Refusal, BudgetBelowOneVoxel) {
    vdb::LoadOptions options;
    options.memoryBudgetMiB = 1e-5;
    EXPECT_THAT(refusal(save({makeBlob({0, 0, 0})}), options), HasSubstr("not even one voxel"));
}

}  // namespace
}  // namespace lumulus::test
