#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "base/image.h"
#include "reference/pixel_paths.h"

namespace lumulus::reference {

/// How long paths are traced to measure the error of a picture.
struct ErrorOrder {
    std::uint64_t seed = 0;  ///< the picture's; paths have random numbers of their own, which `Renderer` has not either
    double seconds = 0.0;    ///< where `paths` is 0: about this long at most, and at least two paths a pixel
    std::uint64_t paths = 0;  ///< at least so many, whatever time they take; the result then repeats to the bit
};

/// A square of a picture, and how far its counted pixels are off in the mean. Radiances in W·m⁻²·sr⁻¹.
struct ErrorBlock {
    int x = 0, y = 0;            ///< pixel of its upper left corner
    int width = 0, height = 0;   ///< pixels; smaller at the right and the lower edge
    std::size_t pixels = 0;      ///< counted ones
    glm::dvec3 mean{0.0};        ///< of the picture over them
    glm::dvec3 difference{0.0};  ///< the picture less the truth, in the mean over them
    double sigma = 0.0;          ///< standard error of the mean of the three differences

    /// Over the mean of the picture; 0 where that is black.
    double bias() const;
    double biasSigma() const;
};

/// The error of a picture I against the truth R, over the pixels of clouds and fog, as `compare` counts them. Standard
/// errors come from the scatter over the pixels that paths were traced through.
struct PictureError {
    std::size_t pixels = 0;  ///< counted ones
    double mean = 0.0;       ///< of the picture over them and the three channels
    double bias = 0.0;       ///< mean (I − R) over `mean`: above 0 where the picture is too bright
    double biasSigma = 0.0;
    double relMse = 0.0;  ///< mean (I − R)² / (I² + .01·mean²) less the noise of the paths: by chance below 0
    double relMseSigma = 0.0;
    std::uint64_t paths = 0, lost = 0;  ///< lost ones met the limit of scattering events
    double seconds = 0.0;
    int edge = 0;                      ///< of the blocks, pixels: an eighth of the picture's height
    std::vector<ErrorBlock> blocks;    ///< that have counted pixels, row by row from the top
    std::vector<std::size_t> counted;  ///< the pixels
};

/// Called between some thousand paths with the share of the work that is done, 0 to 1; what it throws ends the work.
using ErrorProgress = std::function<void(double done)>;

/// 1024 to 8192 pixels of a picture with the unbiased paths that were traced through them, by which the error is known
/// of any picture of that scene that does not depend on these paths.
class ErrorProbes {
  public:
    /// On all threads of TBB. Pixels are drawn more often where the picture is bright, since the noise of paths is
    /// there, and weighted for it; all of them have as many paths. The truth of a pixel is the mean over its area.
    /// Absent where no pixel shows a cloud or fog. `paths` has to outlive the call alone.
    static std::optional<ErrorProbes> trace(const LayeredImage& picture, const PixelPaths& paths,
                                            const ErrorOrder& order, const ErrorProgress& progress);

    /// The error of that picture, or of another with the same layers of transmittance.
    PictureError errorOf(const LayeredImage& picture) const;

  private:
    class Meter;
    explicit ErrorProbes(std::shared_ptr<const Meter> meter) : meter_(std::move(meter)) {}

    std::shared_ptr<const Meter> meter_;
};

/// Adds the layers error.bias and error.sigma: the mean difference of the pixel's block (mean of the channels), and its
/// standard error, W·m⁻²·sr⁻¹; 0 where no pixel counts.
void addErrorLayers(LayeredImage& picture, const PictureError& error);

}  // namespace lumulus::reference
