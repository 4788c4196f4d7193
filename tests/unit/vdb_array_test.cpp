// Densities in memory in the place of a file.
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "base/error.h"
#include "support/temporary_folder.h"
#include "vdb/load.h"
#include "vdb/load_array.h"
#include "vdb/write.h"

namespace lumulus::vdb {
namespace {

/// 9 × 10 × 17 values, none of them where another order of the axes would have it; those at the lower ends are 0.
struct Values {
    glm::ivec3 size{9, 10, 17};
    std::vector<float> all;

    Values() {
        for (int x = 0; x < size.x; ++x)
            for (int y = 0; y < size.y; ++y)
                for (int z = 0; z < size.z; ++z)
                    all.push_back(x * y * z == 0 ? 0.0F : 0.01F * static_cast<float>(x + 10 * y + 100 * z));
    }
    float& at(int x, int y, int z) { return all[static_cast<std::size_t>((x * size.y + y) * size.z + z)]; }
    DensityArray array() const { return {"array", size, {2.0, 3.0, 4.0}, {100.0, -7.0, 0.5}, all}; }
};

TEST(Array, IsLikeAFileOfTheSameValues) {
    Values values;
    Volume volume;
    volume.size = values.size;
    for (int z = 0; z < values.size.z; ++z)
        for (int y = 0; y < values.size.y; ++y)
            for (int x = 0; x < values.size.x; ++x) volume.density.push_back(values.at(x, y, z));
    volume.toWorld.linear = glm::dmat3(glm::dvec3(2, 0, 0), glm::dvec3(0, 3, 0), glm::dvec3(0, 0, 4));
    volume.toWorld.translation = glm::dvec3(100.0, -7.0, 0.5) - 0.5 * glm::dvec3(2.0, 3.0, 4.0);
    const test::TemporaryFolder folder;
    write(volume, folder.path() / "a.vdb");
    const LoadResult file = load(folder.path() / "a.vdb", {}), array = loadArray(values.array(), {});
    EXPECT_EQ(array.volume.size, file.volume.size);
    EXPECT_EQ(array.volume.density, file.volume.density);
    EXPECT_EQ(array.volume.maximum, file.volume.maximum);
    EXPECT_EQ(array.volume.toWorld.translation, file.volume.toWorld.translation);
    EXPECT_EQ(array.volume.toWorld.linear, file.volume.toWorld.linear);
}

TEST(Array, RefusesWhatIsNoDensity) {
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -5.0F}) {
        Values values;
        values.at(8, 9, 16) = bad;
        EXPECT_THROW(loadArray(values.array(), {}), InputError);
        LoadOptions options;
        options.clamp = true;
        const LoadResult clamped = loadArray(values.array(), options);
        EXPECT_EQ(clamped.warnings.size(), 1U);
        values.at(8, 9, 16) = 0.0F;
        EXPECT_EQ(clamped.volume.density, loadArray(values.array(), {}).volume.density);
    }
}

TEST(Array, RefusesShapes) {
    const Values values;
    DensityArray array = values.array();
    array.size.x += 1;
    EXPECT_THROW(loadArray(array, {}), InputError);
    array = values.array();
    array.size = glm::ivec3(0);
    array.values = {};
    EXPECT_THROW(loadArray(array, {}), InputError);
    for (const double edge : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), 1e300}) {
        array = values.array();
        array.edges.y = edge;
        EXPECT_THROW(loadArray(array, {}), InputError);
    }
    array = values.array();
    array.origin.z = std::numeric_limits<double>::infinity();
    EXPECT_THROW(loadArray(array, {}), InputError);
}

}  // namespace
}  // namespace lumulus::vdb
