#include "vdb/describe.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

#include "base/error.h"
#include "base/interrupt.h"
#include "vdb/choose_grid.h"
#include "vdb/convert.h"
#include "vdb/file.h"
#include "vdb/tree_field.h"

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
        if (!std::isfinite(value)) {
            values.notFinite += it.getVoxelCount();
            continue;
        }
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

/// The box of the world around the cubes of all voxels from `low` to `high`.
void surround(Place& place, const glm::ivec3& low, const glm::ivec3& high) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    place.minimum = glm::dvec3(infinity);
    place.maximum = glm::dvec3(-infinity);
    for (int corner = 0; corner < 8; ++corner) {
        const glm::bvec3 upper((corner & 1) != 0, (corner & 2) != 0, (corner & 4) != 0);
        const glm::dvec3 point =
            place.toWorld.point(glm::mix(glm::dvec3(low) - 0.5, glm::dvec3(high) + 0.5, glm::dvec3(upper)));
        place.minimum = glm::min(place.minimum, point);
        place.maximum = glm::max(place.maximum, point);
    }
}

Place placeOf(const openvdb::GridBase& grid, const GridInfo& info) {
    constexpr double straight = 1e-6;  // share of an axis that may lie along another
    Place place;
    place.toWorld = indexToMetres(grid);
    const glm::dmat3& linear = place.toWorld.linear;
    place.mirrored = glm::determinant(linear) < 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 across = linear[axis];
        across[axis] = 0.0;
        place.rotated = place.rotated || glm::length(across) > straight * glm::length(linear[axis]);
    }
    place.minimum = place.maximum = place.toWorld.translation;
    if (info.activeVoxels > 0) surround(place, info.activeMinimum, info.activeMaximum);
    return place;
}

std::optional<OpticalThickness> thicknessOf(const openvdb::GridBase::Ptr& grid, const std::string& file) {
    try {
        const Volume volume = convert(grid, {}, file).volume;
        if (volume.empty()) return std::nullopt;
        constexpr double extinction = 1.0;
        return opticalThickness(columnSums(volume), volume.toWorld, extinction);
    } catch (const InputError&) {
        return std::nullopt;  // values that are no densities
    } catch (const std::bad_alloc&) {
        return std::nullopt;
    }
}

/// Bricks with active voxels, and those of the box around them.
std::pair<std::uint64_t, double> bricksOf(const openvdb::TreeBase& tree, const GridInfo& info) {
    constexpr std::uint64_t voxels = 512;
    const std::uint64_t inTiles = (tree.activeVoxelCount() - tree.activeLeafVoxelCount()) / voxels;
    const glm::dvec3 low(info.activeMinimum >> 3), high(info.activeMaximum >> 3);
    const glm::dvec3 extent = high - low + 1.0;
    return {tree.leafCount() + inTiles, extent.x * extent.y * extent.z};
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
    if (info.affine) info.place = placeOf(grid, info);
    if (grid.isType<openvdb::FloatGrid>()) info.values = measureValues<openvdb::FloatGrid>(grid);
    if (grid.isType<openvdb::DoubleGrid>()) info.values = measureValues<openvdb::DoubleGrid>(grid);
    if (info.values) info.bricks = bricksOf(grid.constBaseTree(), info);
    return info;
}

}  // namespace

std::vector<GridInfo> describe(const std::filesystem::path& path) {
    const ReadLimits limits;
    GridFile file(path, limits);
    const openvdb::GridPtrVec& grids = file.grids();
    const std::vector<GridLabel> labels = file.labels();
    std::vector<GridInfo> infos;
    for (std::size_t i = 0; i < grids.size(); ++i) {
        stopIfInterrupted();
        infos.push_back(describeGrid(*file.read(i)));
    }
    try {
        infos[chooseGrid(labels, "", path.string(), "cloud.0.grid").index].taken = true;
    } catch (const InputError&) {
        // no grid is a density
    }
    // last, since it sets inactive values to 0
    for (std::size_t i = 0; i < grids.size(); ++i)
        if (labels[i].isScalar && !labels[i].levelSet) infos[i].thickness = thicknessOf(grids[i], path.string());
    return infos;
}

}  // namespace lumulus::vdb
