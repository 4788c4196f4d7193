#include "vdb/load.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "vdb/file.h"
#include "vdb/sparse_field.h"
#include "vdb/transform.h"

namespace lumulus::vdb {
namespace {

namespace fs = std::filesystem;

std::string listGrids(const openvdb::GridPtrVec& grids) {
    std::string list;
    for (const openvdb::GridBase::Ptr& grid : grids) {
        list += fmt::format("{}\"{}\" ({})", list.empty() ? "" : ", ", grid->getName(), valueType(*grid));
    }
    return list;
}

const openvdb::GridBase& chooseGrid(const openvdb::GridPtrVec& grids, const std::string& name, const fs::path& path) {
    const auto named = [&](const std::string& wanted) {
        return std::find_if(grids.begin(), grids.end(), [&](const auto& grid) { return grid->getName() == wanted; });
    };
    const auto isFloat = [](const auto& grid) { return grid->template isType<openvdb::FloatGrid>(); };
    auto found = grids.end();
    if (!name.empty()) {
        found = named(name);
        if (found == grids.end()) {
            throw InputError(fmt::format("the file has no grid \"{}\"", name), path.string(),
                             "choose one of " + listGrids(grids));
        }
    } else {
        found = named("density");
        if (found == grids.end() || !isFloat(*found)) found = std::find_if(grids.begin(), grids.end(), isFloat);
        if (found == grids.end()) {
            throw InputError("the file has no float grid, but " + listGrids(grids), path.string(),
                             "save the density as a float grid");
        }
    }
    const openvdb::GridBase& grid = **found;
    if (!isFloat(*found)) {
        throw InputError(fmt::format("grid \"{}\" holds values of type {}, not float", grid.getName(), valueType(grid)),
                         path.string(), "choose a float grid of " + listGrids(grids));
    }
    if (grid.getGridClass() == openvdb::GRID_LEVEL_SET) {
        throw InputError(fmt::format("grid \"{}\" is a level set, not a density", grid.getName()), path.string(),
                         "convert it to a fog volume (OpenVDB's sdfToFogVolume)");
    }
    return grid;
}

/// The transform from index coordinates to metres. It is taken from mapped vectors, since the conventions of OpenVDB's
/// matrices differ between maps.
Affine gridTransform(const openvdb::GridBase& grid, const fs::path& path) {
    if (!grid.transform().isLinear()) {
        throw InputError(fmt::format("grid \"{}\" has a frustum transform", grid.getName()), path.string(),
                         "resample it to a grid with an affine transform");
    }
    const openvdb::math::MapBase& map = *grid.transform().baseMap();
    const auto toGlm = [](const openvdb::Vec3d& v) { return glm::dvec3(v.x(), v.y(), v.z()); };
    Affine affine;
    affine.linear = glm::dmat3(toGlm(map.applyJacobian({1, 0, 0})), toGlm(map.applyJacobian({0, 1, 0})),
                               toGlm(map.applyJacobian({0, 0, 1})));
    affine.translation = toGlm(map.applyMap({0, 0, 0}));
    return affine;
}

IndexBox toBox(const openvdb::CoordBBox& box) {
    return {{box.min().x(), box.min().y(), box.min().z()}, {box.max().x(), box.max().y(), box.max().z()}};
}

/// Lists the tree's leaves and tiles; the leaves' values stay in the tree.
SparseField listBlocks(const openvdb::FloatTree& tree) {
    SparseField field;
    field.background = tree.background();
    openvdb::CoordBBox bounds;
    if (!tree.evalActiveVoxelBoundingBox(bounds)) return field;
    field.bounds = toBox(bounds);
    field.blocks.reserve(tree.leafCount());
    for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf) {
        field.blocks.push_back({toBox(leaf->getNodeBoundingBox()), leaf->buffer().data(), 0.0F});
    }
    auto tile = tree.cbeginValueAll();
    tile.setMaxDepth(openvdb::FloatTree::ValueAllCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
        if (*tile == field.background) continue;
        openvdb::CoordBBox box;
        tile.getBoundingBox(box);
        field.blocks.push_back({toBox(box), nullptr, *tile});
    }
    return field;
}

void refuseBadValues(const Survey& survey, const SparseField& field, const std::string& name, const fs::path& path) {
    const std::string mend = "densities are finite and not negative";
    if (!(field.background >= 0.0F) || std::isinf(field.background)) {
        throw InputError(fmt::format("grid \"{}\" has the background {}", name, field.background), path.string(), mend);
    }
    if (survey.bad) {
        const glm::ivec3 at = survey.bad->at;
        throw InputError(fmt::format("grid \"{}\" holds the value {} at voxel ({}, {}, {})", name, survey.bad->value,
                                     at.x, at.y, at.z),
                         path.string(), mend);
    }
}

std::int64_t fitLimits(const IndexBox& crop, const LoadOptions& options, const fs::path& path, LoadResult& result) {
    const glm::i64vec3 extent = crop.extent();
    const double budget = options.memoryBudgetMiB * 1024.0 * 1024.0;
    const std::int64_t n = chooseCoarsening(extent, budget, options.maxExtent);
    if (n == 0) {
        throw InputError(fmt::format("not even one voxel fits the memory budget of {} MiB and {} voxels a side",
                                     options.memoryBudgetMiB, options.maxExtent),
                         path.string(), "raise the memory budget");
    }
    if (n > 1) {
        const glm::ivec3 size = coarseSize(extent, n);
        result.warnings.push_back(fmt::format(
            "{}: {}x{}x{} voxels are more than {} MiB or {} voxels a side hold: averaged to {}x{}x{} (boxes of {}^3)",
            path.string(), extent.x, extent.y, extent.z, options.memoryBudgetMiB, options.maxExtent, size.x, size.y,
            size.z, n));
    }
    return n;
}

/// MiB at the full resolution, or the one that the limit of the extent leaves.
double wantedMiB(const IndexBox& crop, const LoadOptions& options) {
    const std::int64_t n = chooseCoarsening(crop.extent(), std::numeric_limits<double>::infinity(), options.maxExtent);
    const glm::dvec3 size = glm::dvec3(coarseSize(crop.extent(), n)) + 2.0;
    return 2.0 * size.x * size.y * size.z / (1024.0 * 1024.0);
}

/// The transform from corner-based voxel coordinates of the result, ring included, to index coordinates of the grid.
Affine voxelToIndex(const IndexBox& crop, std::int64_t n) {
    const auto edge = static_cast<double>(n);
    Affine affine;
    affine.linear = glm::dmat3(edge);
    affine.translation = glm::dvec3(crop.minimum) - 0.5 - edge;
    return affine;
}

LoadResult convert(const openvdb::GridBase& base, const LoadOptions& options, const fs::path& path) {
    LoadResult result;
    const std::string name = base.getName();
    // the grid's own transform may be singular as well
    result.gridToWorld = composeTransforms(glm::dmat4(1.0), gridTransform(base, path), path.string());
    const SparseField field = listBlocks(static_cast<const openvdb::FloatGrid&>(base).tree());
    Survey survey;
    if (!field.bounds.empty()) survey = surveyField(field);
    refuseBadValues(survey, field, name, path);
    if (field.background > 0.0F) {
        result.warnings.push_back(
            fmt::format("{}: grid \"{}\" has the background {}: cut off outside its active voxels", path.string(), name,
                        field.background));
    }
    if (survey.occupied.empty()) {
        result.warnings.push_back(fmt::format("{}: grid \"{}\" {}: the cloud is empty", path.string(), name,
                                              field.bounds.empty() ? "has no active voxels" : "is zero everywhere"));
        survey.occupied = {field.bounds.minimum, field.bounds.minimum};
    }
    const std::int64_t n = fitLimits(survey.occupied, options, path, result);
    result.wantedMiB = wantedMiB(survey.occupied, options);
    result.volume = rasteriseField(field, survey.occupied, n);
    result.voxelToGrid = voxelToIndex(survey.occupied, n);
    result.volume.toWorld = composed(result.gridToWorld, result.voxelToGrid);
    result.volume.name = name;
    return result;
}

}  // namespace

LoadResult load(const fs::path& path, const LoadOptions& options) {
    const openvdb::GridPtrVec grids = readGrids(path);
    const openvdb::GridBase& grid = chooseGrid(grids, options.grid, path);
    try {
        return convert(grid, options, path);
    } catch (const std::bad_alloc&) {
        throw Error(fmt::format("grid \"{}\" does not fit the memory of this machine", grid.getName()), path.string(),
                    "lower the memory budget");
    }
}

}  // namespace lumulus::vdb
