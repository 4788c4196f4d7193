#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>

#include "base/image.h"
#include "base/progress.h"
#include "reference/picture_correction.h"
#include "reference/picture_error.h"
#include "render/renderer.h"
#include "scene/quality.h"
#include "scene/scene.h"
#include "volume/load.h"

namespace lumulus::cli {

/// What `lumulus render` measures of the error of its picture, and whether it corrects it.
struct ErrorOptions {
    bool wanted = false;
    bool correct = false;                ///< by paths, however good the picture is
    bool uncorrected = false;            ///< never, however bad it is
    std::optional<double> seconds;       ///< in the place of the time that the picture took
    std::optional<std::uint64_t> paths;  ///< in the place of a time

    /// Whether the error is to be measured.
    bool measured() const { return wanted || seconds || paths; }
    bool used() const { return measured() || correct; }
};

/// Measures the error of a picture by unbiased paths, and corrects it, where that is asked for. Where photon maps make
/// the light of a cloud wrong, the picture is corrected unasked, by a number of paths that the quality says.
class ErrorOfPicture {
  public:
    /// `quality` as RenderOptions has it. Errors: InputError for options that make no sense.
    ErrorOfPicture(const ErrorOptions& options, std::optional<scene::Quality> quality, Steps& steps);

    /// How the renderer is to read the clouds, so that paths have them too; empty where nothing is asked for. It
    /// refuses clouds that are too large for paths. This object has to outlive it.
    ReadClouds reader();

    /// Measures the error of a picture that took `pictureSeconds`, corrects it, and notes what was found in its layers
    /// and attributes. `clouds`: of the picture's statistics. `timed`: the run has a limit of time, so that nothing is
    /// done unasked. Errors: Error where interrupted.
    void measure(LayeredImage& image, const scene::Scene& scene, std::span<const CloudSummary> clouds,
                 double pictureSeconds, bool timed);

    /// Seconds that it took; 0 where there was nothing to do.
    double seconds() const;
    /// Adds the objects `error` and `correction` to those of --stats.
    void addTo(nlohmann::ordered_json& statistics) const;
    /// Says on stderr what was found.
    void tell(bool quiet) const;

  private:
    /// Whether a picture is corrected, and how many paths it takes unasked.
    struct Plan {
        bool correct = false;
        std::uint64_t paths = 0, events = 0;  ///< 0: as asked
        double leastEvenness = 0.0;           ///< reference::CorrectionOrder's
    };

    Plan planOf(const LayeredImage& image, const scene::Scene& scene, std::span<const CloudSummary> clouds,
                bool timed) const;
    void note(LayeredImage& image) const;
    void tellLost() const;

    const ErrorOptions& options_;
    scene::Quality quality_;
    Steps& steps_;
    CloudVolumes clouds_;
    std::optional<reference::PictureError> error_,
        before_;  ///< of the picture that is written, and before its correction
    std::optional<reference::Correction> correction_;
    bool nothingToSee_ = false;
};

}  // namespace lumulus::cli
