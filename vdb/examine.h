#pragma once

#include <openvdb/openvdb.h>

#include <string>
#include <vector>

#include "vdb/load.h"
#include "vdb/survey.h"

/// What a grid has to be to become a cloud (inside vdb/ only: the header costs seconds).
namespace lumulus::vdb {

/// Looks over one grid and says what is wrong with it.
class Examiner {
  public:
    /// `file` stands in messages; both must outlive this. Errors: InputError for a transform that no cloud may have.
    Examiner(const openvdb::GridBase& grid, const LoadOptions& options, const std::string& file);

    const std::string& grid() const { return grid_; }       ///< with its name, for messages
    const Affine& gridToWorld() const { return toWorld_; }  ///< index coordinates → metres
    const std::vector<std::string>& warnings() const { return warnings_; }

    void warn(const std::string& text) { warnings_.push_back(file_ + ": " + text); }
    void warnOfBackground(double background);
    /// Whether there are values that are no densities and are to become 0. Errors: InputError where that is too much.
    bool hasBadValues(const Survey& survey);
    /// The box that becomes the volume; a single voxel where nothing is above 0.
    IndexBox cropped(const Survey& survey, bool hasActive);

  private:
    [[noreturn]] void refuse(const BadValue& bad, const Survey& survey) const;

    const LoadOptions& options_;
    const std::string& file_;
    std::string grid_;
    Affine toWorld_;
    std::vector<std::string> warnings_;
};

}  // namespace lumulus::vdb
