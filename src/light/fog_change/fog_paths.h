#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "light/fog_change/cut_phase.h"
#include "light/fog_light/fog_layers.h"

namespace lumulus::fog_change {

/// A level layer as light walks through it: its forward peak counts as not scattered.
struct WalkedLayer {
    fog_light::FogLayer layer;
    CutPhase phase;
    glm::dvec3 scattering{0.0};  ///< 1/m, without the peak
    glm::dvec3 extinction{0.0};  ///< 1/m, without the peak
    glm::dvec3 peak{0.0};        ///< 1/m, of the peak alone
    double walked = 0.0;         ///< extinction that decides where light is scattered [1/m]
};

/// ∫ of a layer's density along a way of `length` metres from a height, which rises by `rise` a metre.
double densityOnWay(const fog_light::FogLayer& layer, double height, double rise, double length);

/// Level layers through which light walks in straight lines from scattering to scattering.
class FogPaths {
  public:
    explicit FogPaths(const std::vector<fog_light::FogLayer>& layers);

    const std::vector<WalkedLayer>& layers() const { return layers_; }
    /// Whether all colours meet the same.
    bool isGrey() const { return grey_; }
    /// Optical depth by colour of a way.
    glm::dvec3 depth(double height, double rise, double length) const;
    /// The same of the peaks alone.
    glm::dvec3 peakDepth(double height, double rise, double length) const;
    /// By how much the optical depth of each colour is more than that by which light walks.
    glm::dvec3 excessDepth(double height, double rise, double length) const;

    struct Collision {
        double distance = 0.0;
        std::size_t layer = 0;
    };
    /// Where light is scattered next on a way: `depths` are those that it meets in each layer before, each
    /// exponentially distributed. None within `length`.
    template <class Depths>
    std::optional<Collision> collision(double height, double rise, double length, const Depths& depths) const {
        std::optional<Collision> first;
        for (std::size_t m = 0; m < layers_.size(); ++m) {
            const double at = distanceOf(layers_[m], height, rise, depths());
            if (at < (first ? first->distance : length)) first = Collision{at, m};
        }
        return first;
    }

  private:
    /// Metres until an optical depth in one layer; infinite where it is never reached.
    static double distanceOf(const WalkedLayer& walked, double height, double rise, double depth);

    std::vector<WalkedLayer> layers_;
    bool grey_ = true;
};

}  // namespace lumulus::fog_change
