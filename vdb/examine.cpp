#include "vdb/examine.h"

#include <fmt/format.h>

#include <string_view>

#include "base/error.h"
#include "base/text.h"
#include "vdb/transform.h"
#include "vdb/tree_field.h"

namespace lumulus::vdb {
namespace {

/// "1 voxel", "2 negative voxels".
std::string counted(std::uint64_t count, std::string_view kind = "") {
    return fmt::format("{} {}voxel{}", count, kind, count == 1 ? "" : "s");
}

}  // namespace

Examiner::Examiner(const openvdb::GridBase& grid, const LoadOptions& options, const std::string& file)
    : options_(options), file_(file), grid_(fmt::format("grid \"{}\"", shortened(oneLine(grid.getName()), 80))) {
    if (!grid.transform().isLinear())
        throw InputError(grid_ + " has a frustum transform", file, "resample it to a grid with an affine transform");
    // the grid's own transform may be singular as well
    toWorld_ = composeTransforms(glm::dmat4(1.0), indexToMetres(grid), file);
}

void Examiner::warnOfBackground(double background) {
    if (background > 0.0)
        warn(fmt::format("{} has the background {:g}: it is 0 outside of its active voxels", grid_, background));
}

bool Examiner::hasBadValues(const Survey& survey) {
    constexpr double tolerated = 0.01;  // of the maximum
    const double maximum = static_cast<double>(survey.maximum);
    const double lowest = survey.lowest ? static_cast<double>(survey.lowest->value) : 0.0;
    if (!options_.clamp && survey.firstOfThem) refuse(*survey.firstOfThem, survey);
    if (!options_.clamp && lowest < -tolerated * maximum) refuse(*survey.lowest, survey);
    if (survey.negatives > 0)
        warn(fmt::format("{} has {}, the smallest {:g}: set to 0", grid_, counted(survey.negatives, "negative "),
                         lowest));
    if (survey.notFinite > 0)
        warn(fmt::format("{} has {} that are infinite or not a number: set to 0", grid_, counted(survey.notFinite)));
    return survey.negatives + survey.notFinite > 0;
}

void Examiner::refuse(const BadValue& bad, const Survey& survey) const {
    const bool distances = survey.notFinite == 0 && -bad.value > 0.5F * survey.maximum;
    throw InputError(
        fmt::format("{} holds the value {} at voxel ({}, {}, {})", grid_, bad.value, bad.at.x, bad.at.y, bad.at.z),
        file_,
        fmt::format("densities are finite and not negative{}; {}.clamp = true sets {} to 0",
                    distances ? " (a level set has to become a fog volume, with OpenVDB's sdfToFogVolume)" : "",
                    options_.keys, counted(survey.notFinite + survey.negatives)));
}

IndexBox Examiner::cropped(const Survey& survey, bool hasActive) {
    if (survey.occupied.empty()) {
        warn(
            fmt::format("{} {}: the cloud is empty", grid_, hasActive ? "is zero everywhere" : "has no active voxels"));
        return {glm::ivec3(0), glm::ivec3(0)};
    }
    const Apart apart = findApart(survey);
    if (apart.voxels > 0)
        warn(fmt::format("{}: {} with {:.2g} of its mass, far from the rest, left out: one at ({}, {}, {})", grid_,
                         counted(apart.voxels), apart.share, apart.at.x, apart.at.y, apart.at.z));
    if (!options_.part) return apart.kept;
    const IndexBox part = intersect({(*options_.part)[0], (*options_.part)[1]}, apart.kept);
    IndexBox box;
    for (const BlockContent& block : survey.blocks) {
        const IndexBox within = intersect(block.occupied, part);
        if (!block.occupied.empty() && !within.empty()) include(box, within);
    }
    return box.empty() ? IndexBox{part.minimum, part.minimum} : box;
}

}  // namespace lumulus::vdb
