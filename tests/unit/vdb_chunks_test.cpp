// Chunks of values as every packer writes them, and with lengths that are not those of their nodes.
#include <gmock/gmock.h>

#include <bit>
#include <cstdint>
#include <limits>
#include <random>
#include <sstream>

#include "unit/vdb_grids.h"
#include "vdb/chunks.h"

namespace lumulus::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Values;

class Chunks : public GridFiles, public ::testing::WithParamInterface<std::uint32_t> {
  protected:
    std::string bytesOf(const openvdb::FloatGrid::Ptr& grid) const {
        std::ostringstream out(std::ios::binary);
        openvdb::io::Stream stream(out);
        stream.setCompression(GetParam());
        stream.write(openvdb::GridCPtrVec{grid});
        return out.str();
    }
};

/// A whole leaf, `noise` of its voxels random, which no packer makes shorter.
openvdb::FloatGrid::Ptr makeLeaf(int noise) {
    std::mt19937 random(7);
    std::uniform_int_distribution<std::uint32_t> bits(0, 0x7F7FFFFF);
    openvdb::FloatGrid::Ptr grid = makeGrid();
    grid->setGridClass(openvdb::GRID_UNKNOWN);  // OpenVDB does not zip fog volumes
    auto accessor = grid->getAccessor();
    for (int i = 0; i < 512; ++i) {
        const float value = i < noise ? std::bit_cast<float>(bits(random)) : 1.0F;
        accessor.setValue(openvdb::Coord(i / 64, i / 8 % 8, i % 8), value);
    }
    return grid;
}

TEST_P(Chunks, AreRead) {
    for (const int noise : {0, 512}) {
        const auto grid = makeLeaf(noise);
        writeAll(file(), bytesOf(grid));
        const vdb::Volume volume = vdb::load(file(), {}).volume;
        ASSERT_EQ(volume.size, glm::ivec3(10));
        for (int i = 0; i < 512; ++i) {
            const openvdb::Coord at(i / 64, i / 8 % 8, i % 8);
            ASSERT_EQ(volume.density[volume.index(at.x() + 1, at.y() + 1, at.z() + 1)], grid->tree().getValue(at));
        }
    }
}

TEST_P(Chunks, OfOtherLengthsAreRefused) {
    for (const int noise : {0, 512}) {
        std::string bytes = bytesOf(makeLeaf(noise));
        // the leaf's mask, which stands in the file a second time before its values: half of it goes
        const std::size_t mask = bytes.rfind(std::string(64, '\xFF'));
        ASSERT_NE(mask, std::string::npos);
        bytes.replace(mask, 32, std::string(32, '\0'));
        writeAll(file(), bytes);
        EXPECT_THAT(refusal(file()), HasSubstr("a chunk of values does not have the length of its node"));
    }
}

constexpr std::uint32_t activeOnly = openvdb::io::COMPRESS_ACTIVE_MASK;
INSTANTIATE_TEST_SUITE_P(Packers, Chunks,
                         Values(openvdb::io::COMPRESS_ZIP | activeOnly, openvdb::io::COMPRESS_BLOSC | activeOnly));

// OpenVDB calls these by their names, and so does the test.
TEST(ChunkReaders, BelieveNoLength) {
    const auto read = [](std::int64_t length, const std::string& content, std::size_t bytes, bool blosc) {
        std::string chunk(reinterpret_cast<const char*>(&length), sizeof(length));
        std::istringstream in(chunk + content, std::ios::binary);
        std::string to(bytes + 1, '!');
        vdb::guardChunks();
        (blosc ? openvdb::io::bloscFromStream : openvdb::io::unzipFromStream)(in, to.data(), bytes);
        EXPECT_EQ(to.back(), '!') << "wrote beyond the buffer";
        return to.substr(0, bytes);
    };
    for (const bool blosc : {false, true}) {
        EXPECT_EQ(read(-4, "abcd", 4, blosc), "abcd");
        EXPECT_EQ(read(0, "", 0, blosc), "");
        EXPECT_EQ(read(3, "xyz", 0, blosc), "");
        for (const std::int64_t length : {-5, -3, 0, -1000000, 1, 4, 15, 40}) {
            EXPECT_THROW(read(length, std::string(100, '\2'), 4, blosc), openvdb::RuntimeError) << length;
        }
        EXPECT_THROW(read(std::numeric_limits<std::int64_t>::min(), "abcd", 4, blosc), openvdb::RuntimeError);
        for (const std::int64_t length : {std::int64_t{1} << 32, std::numeric_limits<std::int64_t>::max()})
            EXPECT_THROW(read(length, "abcd", 4, blosc), openvdb::RuntimeError) << length;
    }
}

}  // namespace
}  // namespace lumulus::test
