#pragma once

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "base/tonemap.h"
#include "scene/scene.h"
#include "service/render/scheduler.h"
#include "service/values/results.h"

namespace lumulus::service {

/// An exposure value that follows what a meter says as an eye does: half a second to bright, two to dark.
class Adaptation {
  public:
    /// The exposure value of now; the first one is that of the meter itself.
    double follow(double metered, Clock::time_point now);
    Clock::time_point last() const { return last_; }

  private:
    std::optional<double> value_;
    Clock::time_point last_;
};

/// The tones of pictures that are served. With the exposure mode `auto` each stream adapts over time; a frame by itself
/// is metered by itself. Where clouds have the light of another sun, what is behind them is metered in their stead, and
/// they are taken to be as much brighter than that as they were last. Not for several threads.
class ExposureDesk {
  public:
    /// `lightOfNow`: whether the clouds of the views have the light of now.
    Tone toneOf(const scene::Image& image, const Job& job, const std::vector<ViewResult>& views, bool lightOfNow,
                Clock::time_point now);

  private:
    std::optional<double> gainWithout(const std::vector<const LayeredImage*>& pictures) const;
    void remember(double gain, const std::vector<const LayeredImage*>& pictures);
    void forgetOld(Clock::time_point now);

    std::map<std::pair<ClientId, std::uint64_t>, Adaptation> streams_;  ///< by client and stream
    double cloudsOverSky_ = 1.0;  ///< gain by the clouds over that by what is behind them, when both were of one light
    std::optional<double> gain_;  ///< the last one
};

}  // namespace lumulus::service
