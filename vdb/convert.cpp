#include "vdb/convert.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "vdb/examine.h"
#include "vdb/survey.h"
#include "vdb/transform.h"
#include "vdb/tree_field.h"

namespace lumulus::vdb {
namespace {

/// MiB of a volume at 2 bytes a voxel.
double mebibytes(const glm::i64vec3& extent, std::int64_t n) {
    const glm::dvec3 size = glm::dvec3(coarseSize(extent, n)) + 2.0;
    return 2.0 * size.x * size.y * size.z / (1024.0 * 1024.0);
}

/// MiB at the full resolution, or the one that the limit of the extent leaves.
double wantedMiB(const IndexBox& crop, int maxExtent) {
    return mebibytes(crop.extent(),
                     chooseCoarsening(crop.extent(), std::numeric_limits<double>::infinity(), maxExtent));
}

/// The transform from corner-based voxel coordinates of the result, ring included, to index coordinates of the grid.
Affine voxelToIndex(const IndexBox& crop, std::int64_t n) {
    const auto edge = static_cast<double>(n);
    Affine affine;
    affine.linear = glm::dmat3(edge);
    affine.translation = glm::dvec3(crop.minimum) - 0.5 - edge;
    return affine;
}

/// Bytes that a volume which is averaged anyway is worth.
double mostBytes(const Survey& survey) {
    constexpr double bytesPerVoxel = 2.0, voxelsPerBlock = 4096.0, always = 1048576.0;
    const auto filled =
        std::ranges::count_if(survey.blocks, [](const BlockContent& block) { return block.voxels > 0; });
    return bytesPerVoxel * std::max(always, voxelsPerBlock * static_cast<double>(filled));
}

/// Makes the volume of one grid step by step.
class Converter {
  public:
    Converter(const openvdb::GridBase& grid, const LoadOptions& options, const std::string& file)
        : options_(options), file_(file), examiner_(grid, options, file) {
        result_.gridToWorld = examiner_.gridToWorld();
        result_.volume.name = grid.getName();
    }

    LoadResult convert(openvdb::FloatTree& tree) {
        SparseField field = listBlocks(tree);
        const Survey survey = surveyField(field, options_.limits.check);
        examiner_.warnOfBackground(static_cast<double>(tree.background()));
        if (examiner_.hasBadValues(survey)) clampValues(field);
        const IndexBox box = examiner_.cropped(survey, tree.activeVoxelCount() > 0);
        const std::int64_t n = fitLimits(box, survey);
        std::string name = std::move(result_.volume.name);
        result_.wantedMiB = wantedMiB(box, options_.maxExtent);
        result_.volume = rasteriseField(field, box, n, options_.limits.check);
        result_.voxelToGrid = voxelToIndex(box, n);
        result_.volume.toWorld = composed(result_.gridToWorld, result_.voxelToGrid);
        result_.volume.name = std::move(name);
        result_.warnings = examiner_.warnings();
        return std::move(result_);
    }

  private:
    /// The edge n of the boxes over which the grid is averaged.
    std::int64_t fitLimits(const IndexBox& box, const Survey& survey) {
        const glm::i64vec3 extent = box.extent();
        const double budget = options_.memoryBudgetMiB * 1024.0 * 1024.0;
        std::int64_t n = chooseCoarsening(extent, budget, options_.maxExtent);
        if (n > 1) n = chooseCoarsening(extent, std::min(budget, mostBytes(survey)), options_.maxExtent);
        if (n == 0)
            throw InputError(fmt::format("not even one voxel fits the memory budget of {} MiB and {} voxels a side",
                                         options_.memoryBudgetMiB, options_.maxExtent),
                             file_, "raise the memory budget");
        if (n > 1) {
            const glm::ivec3 size = coarseSize(extent, n);
            examiner_.warn(
                fmt::format("{}x{}x{} voxels are more than {} MiB or {} voxels a side hold: averaged to {}x{}x{} "
                            "(boxes of {}^3); {}",
                            extent.x, extent.y, extent.z, options_.memoryBudgetMiB, options_.maxExtent, size.x, size.y,
                            size.z, n, mendOfCoarseness(box, survey)));
        }
        return n;
    }

    /// What a person can do about a grid that is averaged.
    std::string mendOfCoarseness(const IndexBox& box, const Survey& survey) const {
        constexpr double sparse = 0.01;
        std::uint64_t voxels = 0;
        for (const BlockContent& block : survey.blocks) voxels += block.voxels;
        const glm::dvec3 extent(box.extent());
        const double share = static_cast<double>(voxels) / (extent.x * extent.y * extent.z);
        if (share < sparse)
            return fmt::format(
                "only {:.2g} of the box holds density: save what lies apart as grids of its own, "
                "one [[cloud]] each",
                share);
        const double wanted = wantedMiB(box, options_.maxExtent);
        const double longest = std::max({extent.x, extent.y, extent.z}) + 2.0;
        if (wanted > options_.memoryBudgetMiB)
            return fmt::format("preparation.memory_budget = {:.0f} keeps {}", std::ceil(wanted),
                               longest > options_.maxExtent ? "more" : "all of them");
        return "divide it into grids of fewer voxels a side, one [[cloud]] each";
    }

    const LoadOptions& options_;
    const std::string& file_;
    Examiner examiner_;
    LoadResult result_;
};

}  // namespace

LoadResult convert(const openvdb::GridBase::Ptr& grid, const LoadOptions& options, const std::string& file) {
    Converter converter(*grid, options, file);
    return converter.convert(asFloats(grid)->tree());
}

}  // namespace lumulus::vdb
