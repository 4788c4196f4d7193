#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

#include "base/image.h"
#include "reference/pixel_paths.h"

namespace lumulus::reference {

/// How long paths are traced to correct a picture. All pixels have as many, and two at least.
struct CorrectionOrder {
    std::uint64_t seed = 0;   ///< the picture's; paths have random numbers of their own
    double seconds = 0.0;     ///< where `paths` is 0: about this long at most
    std::uint64_t paths = 0;  ///< at least so many; the result then repeats to the bit
    /// With `paths`: no further round of them after so many scattering events, where these are many in each; 0: no
    /// limit.
    std::uint64_t events = 0;
    /// The picture stays as it is where the effective number of paths, (Σx)²/Σx² of their light x, is a smaller share
    /// of their number: where few paths carry most of the light, more of it may be missing than their scatter tells.
    double leastEvenness = 0.0;
};

/// What a correction was made by.
struct Correction {
    std::size_t pixels = 0;  ///< that are corrected: those of clouds and fog
    std::uint64_t paths = 0, events = 0;
    std::uint64_t lost =
        0;  ///< paths that met the limit of scattering events, whose missing light counts as difference
    double seconds = 0.0;
    double evenness = 1.0;  ///< as CorrectionOrder has it
    bool made = true;       ///< false: the picture is as it was, for that reason
};

/// Called between some thousand paths with the share of the work that is done, 0 to 1; what it throws ends the work.
using PathProgress = std::function<void(double done)>;

/// Brings the clouds and the fog of a picture (R, G, B and cloud.R, .G, .B) nearer to the truth by unbiased paths
/// through all of their pixels: the mean difference between paths and picture is added, less the noise that it has
/// (filterDifference). The mean over all these pixels then has no bias, channel by channel, and with many paths no
/// pixel has. Absent where no pixel shows a cloud or fog.
std::optional<Correction> correct(LayeredImage& picture, const PixelPaths& paths, const CorrectionOrder& order,
                                  const PathProgress& progress);

}  // namespace lumulus::reference
