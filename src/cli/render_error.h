#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "base/image.h"
#include "base/progress.h"
#include "reference/picture_error.h"
#include "render/renderer.h"
#include "scene/scene.h"
#include "volume/load.h"

namespace lumulus::cli {

/// What `lumulus render` measures of the error of its picture.
struct ErrorOptions {
    bool wanted = false;
    bool correct = false;                ///< take the measured error out of the picture
    std::optional<double> seconds;       ///< in the place of the time that the picture took
    std::optional<std::uint64_t> paths;  ///< in the place of a time

    bool used() const { return wanted || correct || seconds || paths; }
};

/// Measures the error of a picture by unbiased paths, where that is asked for.
class ErrorOfPicture {
  public:
    /// Errors: InputError for options that make no sense.
    ErrorOfPicture(const ErrorOptions& options, Steps& steps);

    /// How the renderer is to read the clouds, so that paths have them too; empty where no error is measured. It
    /// refuses clouds that are too large for paths. This object has to outlive it.
    ReadClouds reader();

    /// Measures the error of a picture that took `pictureSeconds`, corrects it where that is asked for, and notes what
    /// was found in its layers and attributes. Errors: Error where interrupted.
    void measure(LayeredImage& image, const scene::Scene& scene, double pictureSeconds);

    /// Seconds that the measurement took; 0 where there was none.
    double seconds() const { return error_ ? error_->seconds : 0.0; }
    /// The object `error` of --stats.
    nlohmann::ordered_json json() const;
    /// Says on stderr what was found.
    void tell(bool quiet) const;

  private:
    const ErrorOptions& options_;
    Steps& steps_;
    CloudVolumes clouds_;
    std::optional<reference::PictureError> error_;
};

}  // namespace lumulus::cli
