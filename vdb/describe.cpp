#include "vdb/describe.h"

#include <algorithm>
#include <limits>

#include "base/interrupt.h"
#include "vdb/file.h"

namespace lumulus::vdb {
namespace {

template <typename Grid>
std::optional<ValueStatistics> measureValues(const openvdb::GridBase& base) {
    const auto& tree = static_cast<const Grid&>(base).tree();
    ValueStatistics values{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(), 0.0,
                           static_cast<double>(tree.background())};
    double count = 0.0;
    for (auto it = tree.cbeginValueOn(); it; ++it) {
        const auto value = static_cast<double>(*it);
        const auto voxels = static_cast<double>(it.getVoxelCount());
        values.minimum = std::min(values.minimum, value);
        values.maximum = std::max(values.maximum, value);
        values.mean += value * voxels;
        count += voxels;
    }
    if (count == 0.0) return std::nullopt;
    values.mean /= count;
    return values;
}

std::string className(openvdb::GridClass gridClass) {
    switch (gridClass) {
        case openvdb::GRID_LEVEL_SET:
            return "level set";
        case openvdb::GRID_FOG_VOLUME:
            return "fog volume";
        case openvdb::GRID_STAGGERED:
            return "staggered";
        default:
            return "unknown";
    }
}

GridInfo describeGrid(const openvdb::GridBase& grid) {
    GridInfo info;
    info.name = grid.getName();
    info.type = valueType(grid);
    info.gridClass = className(grid.getGridClass());
    info.levelSet = grid.getGridClass() == openvdb::GRID_LEVEL_SET;
    info.affine = grid.transform().isLinear();
    info.activeVoxels = grid.activeVoxelCount();
    if (info.activeVoxels > 0) {
        const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
        info.activeMinimum = {box.min().x(), box.min().y(), box.min().z()};
        info.activeMaximum = {box.max().x(), box.max().y(), box.max().z()};
    }
    const openvdb::Vec3d voxel = grid.voxelSize();
    info.voxelSize = {voxel.x(), voxel.y(), voxel.z()};
    if (grid.isType<openvdb::FloatGrid>()) info.values = measureValues<openvdb::FloatGrid>(grid);
    if (grid.isType<openvdb::DoubleGrid>()) info.values = measureValues<openvdb::DoubleGrid>(grid);
    return info;
}

}  // namespace

std::vector<GridInfo> describe(const std::filesystem::path& path) {
    std::vector<GridInfo> infos;
    for (const openvdb::GridBase::Ptr& grid : readGrids(path)) {
        stopIfInterrupted();
        infos.push_back(describeGrid(*grid));
    }
    return infos;
}

}  // namespace lumulus::vdb
