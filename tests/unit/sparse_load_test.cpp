#include "vdb/load_sparse.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "unit/vdb_grids.h"

namespace lumulus::test {
namespace {

using openvdb::Coord;
using testing::HasSubstr;

class SparseLoad : public GridFiles {
  protected:
    /// The sparse field has the dense loader's values anywhere in the world.
    static void expectDenseValues(const std::filesystem::path& path) {
        vdb::LoadOptions options;
        options.memoryBudgetMiB = 64.0;
        const vdb::LoadResult dense = vdb::load(path, options);
        vdb::SparseResult sparse = vdb::loadSparse(path, options);
        EXPECT_EQ(sparse.volume.maximum, dense.volume.maximum);
        EXPECT_EQ(sparse.volume.name, dense.volume.name);
        EXPECT_EQ(sparse.warnings, dense.warnings);
        sparse.volume.format = vdb::DensityFormat::r16f;
        vdb::layOut(sparse.volume, {}, stopIfInterrupted);
        const std::vector<std::byte> texels = vdb::allTexels(sparse.volume);
        std::mt19937 random(2);
        std::uniform_real_distribution<double> uniform(0.0, 1.0);
        const glm::dmat3 inverse = glm::inverse(sparse.volume.toWorld.linear);
        for (int i = 0; i < 20000; ++i) {
            const glm::dvec3 u(uniform(random), uniform(random), uniform(random));
            const glm::dvec3 voxel = u * glm::dvec3(dense.volume.size);
            const glm::dvec3 there = inverse * (dense.volume.toWorld.point(voxel) - sparse.volume.toWorld.translation);
            const auto found = static_cast<double>(vdb::densityAt(sparse.volume, texels, glm::vec3(there)));
            ASSERT_NEAR(found, denseAt(dense.volume, voxel) / static_cast<double>(dense.volume.maximum), 1e-3);
        }
    }

    static double denseAt(const vdb::Volume& volume, const glm::dvec3& voxel) {
        const glm::dvec3 centred = glm::clamp(voxel - 0.5, glm::dvec3(0.0), glm::dvec3(volume.size) - 1.001);
        const glm::ivec3 first(centred);
        const glm::dvec3 part = centred - glm::dvec3(first);
        double sum = 0.0;
        for (int corner = 0; corner < 8; ++corner) {
            const glm::ivec3 step(corner & 1, corner >> 1 & 1, corner >> 2);
            const glm::dvec3 weight = glm::mix(1.0 - part, part, glm::dvec3(step));
            const glm::ivec3 at = first + step;
            sum += weight.x * weight.y * weight.z * static_cast<double>(volume.density[volume.index(at.x, at.y, at.z)]);
        }
        return sum;
    }

    /// Three lumps with inactive values beside them, and a tile.
    static openvdb::FloatGrid::Ptr lumps() {
        const openvdb::FloatGrid::Ptr grid = makeGrid();
        std::mt19937 random(4);
        std::uniform_real_distribution<float> uniform(0.1F, 1.0F);
        auto access = grid->getAccessor();
        for (const Coord& middle : {Coord(-5, 3, 40), Coord(60, -20, 7), Coord(20, 20, 20)})
            for (int x = -11; x <= 11; ++x)
                for (int y = -11; y <= 11; ++y)
                    for (int z = -11; z <= 11; ++z)
                        if (x * x + y * y + z * z < 121) access.setValueOn(middle + Coord(x, y, z), uniform(random));
        access.setValueOff(Coord(61, -20, 7), 5.0F);
        grid->tree().addTile(1, Coord(40, 8, 16), 0.5F, true);
        return grid;
    }

    void saveSeekable(const openvdb::GridPtrVec& grids, std::uint32_t compression) const {
        openvdb::io::File out(file().string());
        out.setCompression(compression);
        out.write(grids);
        out.close();
    }
};

TEST_F(SparseLoad, AStreamOfOneGrid) {
    expectDenseValues(save({lumps()}));
}

TEST_F(SparseLoad, FilesThatTellWhereGridsLie) {
    constexpr std::uint32_t none = openvdb::io::COMPRESS_NONE, masks = openvdb::io::COMPRESS_ACTIVE_MASK;
    for (const std::uint32_t compression :
         {none, masks | openvdb::io::COMPRESS_ZIP, masks | openvdb::io::COMPRESS_BLOSC}) {
        const openvdb::FloatGrid::Ptr other = makeBlob(Coord(100, 0, 0), 20), halves = lumps();
        other->setName("temperature");
        halves->setSaveFloatAsHalf(true);
        saveSeekable({other, halves}, compression);
        expectDenseValues(file());
    }
}

TEST_F(SparseLoad, StreamsOfSeveralGridsAndDoubles) {
    const openvdb::FloatGrid::Ptr other = makeBlob(Coord(100, 0, 0), 20);
    other->setName("temperature");
    expectDenseValues(save({other, lumps()}));
    const openvdb::DoubleGrid::Ptr doubles = openvdb::DoubleGrid::create();
    doubles->setName("density");
    const openvdb::FloatGrid::Ptr floats = lumps();
    for (auto value = floats->cbeginValueOn(); value; ++value)
        if (value.isVoxelValue()) doubles->tree().setValue(value.getCoord(), static_cast<double>(*value));
    expectDenseValues(save({doubles}));
}

TEST_F(SparseLoad, SaysWhatLoadSays) {
    const openvdb::FloatGrid::Ptr grid = lumps();
    grid->tree().setValue(Coord(0, 0, 40), -0.5F);
    save({grid});
    try {
        vdb::loadSparse(file(), {});
        FAIL();
    } catch (const InputError& error) {
        EXPECT_EQ(error.what(), refusal(file()));
    }
    vdb::LoadOptions clamp;
    clamp.clamp = true;
    EXPECT_EQ(vdb::loadSparse(file(), clamp).warnings, vdb::load(file(), clamp).warnings);
}

TEST_F(SparseLoad, TruncatedFilesAreRefused) {
    save({lumps()});
    const auto bytes = std::filesystem::file_size(file());
    for (const double share : {0.3, 0.6, 0.9, 0.99}) {
        std::filesystem::resize_file(file(), static_cast<std::uintmax_t>(share * static_cast<double>(bytes)));
        EXPECT_THROW(vdb::loadSparse(file(), {}), InputError) << share;
        save({lumps()});
    }
}

TEST_F(SparseLoad, AFileThatChangesAfterwardsIsNamed) {
    save({lumps()});
    vdb::SparseResult sparse = vdb::loadSparse(file(), {});
    vdb::layOut(sparse.volume, {}, stopIfInterrupted);
    std::filesystem::resize_file(file(), std::filesystem::file_size(file()) / 2);
    try {
        vdb::allTexels(sparse.volume);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr(file().string()));
    }
}

TEST_F(SparseLoad, TwoCloudsFarApartTakeTheBricksOfTwo) {
    const openvdb::FloatGrid::Ptr one = makeBlob(Coord(0, 0, 0), 12), two = makeBlob(Coord(0, 0, 0), 12);
    const openvdb::FloatGrid::Ptr away = makeBlob(Coord(20003, 5, 9), 12);
    for (auto value = away->cbeginValueOn(); value; ++value) two->tree().setValue(value.getCoord(), *value);
    const auto laidOut = [&](const openvdb::FloatGrid::Ptr& grid) {
        vdb::SparseVolume volume = vdb::loadSparse(save({grid}), {}).volume;
        vdb::layOut(volume, {}, stopIfInterrupted);
        return volume;
    };
    const vdb::SparseVolume alone = laidOut(one), both = laidOut(two);
    EXPECT_GE(both.size.x, 20000);
    EXPECT_LE(both.slots.size(), 2.6 * static_cast<double>(alone.slots.size()));
    // an empty box 20000 voxels long adds roots and cells of majorants
    EXPECT_LE(both.gpuBytes(), 2.0 * static_cast<double>(alone.gpuBytes()) + 1.0e6);
}

}  // namespace
}  // namespace lumulus::test
