#pragma once

#include <gtest/gtest.h>
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "base/error.h"
#include "support/temporary_folder.h"
#include "vdb/load.h"

/// Makes OpenVDB files of all kinds for the tests of the loader.
namespace lumulus::test {

class GridFiles : public ::testing::Test {
  protected:
    GridFiles() { openvdb::initialize(); }

    std::filesystem::path file(const std::string& name = "grid.vdb") const { return folder_ / name; }

    std::filesystem::path save(const openvdb::GridCPtrVec& grids) const {
        std::ofstream out(file(), std::ios::binary);
        openvdb::io::Stream(out).write(grids);
        return file();
    }

    vdb::LoadResult loadGrid(const openvdb::FloatGrid::Ptr& grid, const vdb::LoadOptions& options = {}) const {
        return vdb::load(save({grid}), options);
    }

    /// The message of the InputError that loading ends with; empty if there is none. Checks that it is one line.
    static std::string refusal(const std::filesystem::path& path, const vdb::LoadOptions& options = {}) {
        try {
            vdb::load(path, options);
        } catch (const InputError& error) {
            const std::string message = error.what();
            EXPECT_EQ(message.find('\n'), std::string::npos) << message;
            EXPECT_NE(message.find(path.string()), std::string::npos) << message;
            return message;
        }
        return {};
    }

  private:
    TemporaryFolder folder_;
};

inline openvdb::FloatGrid::Ptr makeGrid(float background = 0.0F, const std::string& name = "density") {
    openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(background);
    grid->setName(name);
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    return grid;
}

/// A small blob of different values around `middle`.
inline openvdb::FloatGrid::Ptr makeBlob(const openvdb::Coord& middle, int radius = 3) {
    openvdb::FloatGrid::Ptr grid = makeGrid();
    auto accessor = grid->getAccessor();
    for (int x = -radius; x <= radius; ++x) {
        for (int y = -radius; y <= radius; ++y) {
            for (int z = -radius; z <= radius; ++z) {
                const float value = 1.0F / static_cast<float>(2 + 3 * x * x + 2 * y * y + z * z + x + y);
                accessor.setValue(middle.offsetBy(x, y, z), value);
            }
        }
    }
    return grid;
}

/// Σ value · volume of a voxel [density · m³].
inline double mass(const vdb::Volume& volume) {
    double sum = 0.0;
    for (const float value : volume.density) sum += static_cast<double>(value);
    return sum * std::abs(glm::determinant(volume.toWorld.linear));
}

/// Whether the outermost voxels are all zero.
inline bool hasRing(const vdb::Volume& volume) {
    for (int z = 0; z < volume.size.z; ++z) {
        for (int y = 0; y < volume.size.y; ++y) {
            for (int x = 0; x < volume.size.x; ++x) {
                const glm::ivec3 at(x, y, z);
                const bool outer = glm::any(glm::equal(at, glm::ivec3(0))) || glm::any(glm::equal(at, volume.size - 1));
                if (outer && volume.density[volume.index(x, y, z)] != 0.0F) return false;
            }
        }
    }
    return true;
}

}  // namespace lumulus::test
