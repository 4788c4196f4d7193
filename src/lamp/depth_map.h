#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

#include "base/interrupt.h"
#include "lamp/clouds.h"
#include "lamp/solids.h"

namespace lumulus::lamp {

/// A cone of directions.
struct Cone {
    glm::dvec3 axis{0.0, 0.0, 1.0};
    double angle = 0.0;  ///< to the axis, radians; up to π
};

/// What a cone of light from a point meets of a sphere: narrower than `cone` where that is; an angle of 0 where it
/// meets nothing of it.
Cone coneToSphere(const glm::dvec3& middle, double radius, const glm::dvec3& point, const Cone& cone);

/// The same for the sphere around all clouds.
inline Cone coneToClouds(const Clouds& clouds, const glm::dvec3& point, const Cone& cone) {
    return coneToSphere(clouds.middle(), clouds.radius(), point, cone);
}

/// Optical depth of clouds around a point: along the directions of a cone, in slices between where each enters the
/// first cloud and leaves the last one. It is Lambert's equal-area map of the cone, or of two half spheres where the
/// cone is wider than one. Of solid bodies it has the distance alone, behind which nothing passes.
class DepthMap {
  public:
    /// No clouds.
    DepthMap() = default;
    /// `edge`: directions across. Errors: what `check` throws.
    DepthMap(const Clouds& clouds, const glm::dvec3& point, const Cone& cone, int edge, const Check& check);

    DepthMap(const Solids& solids, const glm::dvec3& point, const Cone& cone, int edge, const Check& check);

    bool empty() const { return sides_.empty(); }

    /// Share of light that passes from the map's point into a direction up to a distance [m]; 1 beside the cone.
    double transmittance(const glm::dvec3& direction, double distance) const;

  private:
    struct Side {
        glm::dmat3 axes{1.0};       ///< columns: across, up, along the cone
        double widest = 0.0;        ///< 1 − cos of the cone's angle
        std::vector<float> ranges;  ///< distances of the first and the last slice of each direction [m]
        std::vector<float> depths;  ///< at the ends of its slices; none for solid bodies
    };

    void begin(const Cone& cone);
    template <class FillTexel>
    void forEachTexel(const Side& side, const glm::dvec3& point, const Check& check, const FillTexel& fill) const;
    void fill(const Clouds& clouds, const glm::dvec3& point, Side& side, const Check& check) const;
    double passed(const Side& side, std::size_t texel, double distance) const;

    int edge_ = 0;
    std::vector<Side> sides_;
};

}  // namespace lumulus::lamp
