#pragma once

#include <cstdint>
#include <optional>

#include "base/image.h"

namespace lumulus::service {

/// The relMSE (mean of Δ²/(R² + 0.01·mean(R)²)) of the noise in `later`, a mean over `laterCount` generations of which
/// `earlier` shows the first `earlierCount`. The variance of their difference is σ²(1/n₁ − 1/n₂), that of `later` is
/// σ²/n₂. Counts pixels with cloud; 0 where there are none. Needs earlierCount < laterCount.
double nestedNoise(const LayeredImage& earlier, int earlierCount, const LayeredImage& later, int laterCount);

/// Estimates the noise of a scene's photons from small pictures of it, taken as the number of generations grows.
class NoiseEstimate {
  public:
    /// Whether a picture that shows so many generations would tell more: the first one, and where their number has
    /// doubled since the last one.
    bool wants(int generations) const;
    /// Takes a picture of the same view as those before. `photons` are those of all its generations.
    void add(LayeredImage picture, int generations, std::uint64_t photons);
    /// Estimated relMSE of a picture that shows so many photons; none before it is known.
    std::optional<double> relMse(std::uint64_t photons) const;
    /// What is known, for a scene of which there is no picture yet.
    NoiseEstimate withoutPicture() const;

  private:
    struct Picture {
        LayeredImage image;
        int generations = 0;
    };
    std::optional<Picture> last_;
    std::optional<double> relMseTimesPhotons_;
};

}  // namespace lumulus::service
