#include "vdb/convert.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "base/error.h"
#include "base/text.h"
#include "vdb/file.h"
#include "vdb/survey.h"
#include "vdb/transform.h"
#include "vdb/tree_field.h"

namespace lumulus::vdb {
namespace {

/// "1 voxel", "2 negative voxels".
std::string counted(std::uint64_t count, std::string_view kind = "") {
    return fmt::format("{} {}voxel{}", count, kind, count == 1 ? "" : "s");
}

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
        : options_(options), file_(file), grid_(fmt::format("grid \"{}\"", shortened(oneLine(grid.getName()), 80))) {
        if (!grid.transform().isLinear())
            throw InputError(grid_ + " has a frustum transform", file,
                             "resample it to a grid with an affine transform");
        // the grid's own transform may be singular as well
        result_.gridToWorld = composeTransforms(glm::dmat4(1.0), indexToMetres(grid), file);
        result_.volume.name = grid.getName();
    }

    LoadResult convert(openvdb::FloatTree& tree) {
        SparseField field = listBlocks(tree);
        const Survey survey = surveyField(field, options_.limits.check);
        hasActive_ = tree.activeVoxelCount() > 0;
        warnOfBackground(static_cast<double>(tree.background()));
        mendValues(survey, field);
        const IndexBox box = cropped(survey);
        const std::int64_t n = fitLimits(box, survey);
        std::string name = std::move(result_.volume.name);
        result_.wantedMiB = wantedMiB(box, options_.maxExtent);
        result_.volume = rasteriseField(field, box, n, options_.limits.check);
        result_.voxelToGrid = voxelToIndex(box, n);
        result_.volume.toWorld = composed(result_.gridToWorld, result_.voxelToGrid);
        result_.volume.name = std::move(name);
        return std::move(result_);
    }

  private:
    void warn(const std::string& text) { result_.warnings.push_back(file_ + ": " + text); }

    void warnOfBackground(double background) {
        if (background > 0.0)
            warn(fmt::format("{} has the background {:g}: it is 0 outside of its active voxels", grid_, background));
    }

    /// Makes values that are no densities 0 where they are small or where the scene asks for it.
    void mendValues(const Survey& survey, SparseField& field) {
        constexpr double tolerated = 0.01;  // of the maximum
        const double maximum = static_cast<double>(survey.maximum);
        const double lowest = survey.lowest ? static_cast<double>(survey.lowest->value) : 0.0;
        if (!options_.clamp && survey.firstOfThem) refuse(*survey.firstOfThem, survey);
        if (!options_.clamp && lowest < -tolerated * maximum) refuse(*survey.lowest, survey);
        if (survey.negatives > 0)
            warn(fmt::format("{} has {}, the smallest {:g}: set to 0", grid_, counted(survey.negatives, "negative "),
                             lowest));
        if (survey.notFinite > 0)
            warn(
                fmt::format("{} has {} that are infinite or not a number: set to 0", grid_, counted(survey.notFinite)));
        if (survey.negatives + survey.notFinite > 0) clampValues(field);
    }

    [[noreturn]] void refuse(const BadValue& bad, const Survey& survey) const {
        const bool distances = survey.notFinite == 0 && -bad.value > 0.5F * survey.maximum;
        throw InputError(
            fmt::format("{} holds the value {} at voxel ({}, {}, {})", grid_, bad.value, bad.at.x, bad.at.y, bad.at.z),
            file_,
            fmt::format("densities are finite and not negative{}; {}.clamp = true sets {} to 0",
                        distances ? " (a level set has to become a fog volume, with OpenVDB's sdfToFogVolume)" : "",
                        options_.keys, counted(survey.notFinite + survey.negatives)));
    }

    /// The box that becomes the volume.
    IndexBox cropped(const Survey& survey) {
        if (survey.occupied.empty()) {
            warn(fmt::format("{} {}: the cloud is empty", grid_,
                             hasActive_ ? "is zero everywhere" : "has no active voxels"));
            return {glm::ivec3(0), glm::ivec3(0)};
        }
        const Apart apart = findApart(survey);
        if (apart.voxels > 0)
            warn(fmt::format("{}: {} with {:.2g} of its mass, far from the rest, left out: one at ({}, {}, {})", grid_,
                             counted(apart.voxels), apart.share, apart.at.x, apart.at.y, apart.at.z));
        return apart.kept;
    }

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
            warn(
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
    std::string grid_;  ///< with its name, for messages
    bool hasActive_ = false;
    LoadResult result_;
};

}  // namespace

LoadResult convert(const openvdb::GridBase::Ptr& grid, const LoadOptions& options, const std::string& file) {
    Converter converter(*grid, options, file);
    return converter.convert(asFloats(grid)->tree());
}

}  // namespace lumulus::vdb
